#include "amontons/base/error.h"
#include "amontons/contact/face.h"
#include "amontons/contact/kinematics.h"

namespace amontons
{
namespace
{
/// e.(u_1 - sum w_k u_k) as a row: (e, -w_1 e, ..., -w_n e).
ContactVector relative_row(int dim, const Eigen::Vector3d &direction, std::span<const double> weights)
{
  ContactVector row(dim * static_cast<Eigen::Index>(1 + weights.size()));
  row.head(dim) = direction.head(dim);
  for (std::size_t k = 0; k < weights.size(); ++k)
    row.segment(dim * static_cast<Eigen::Index>(1 + k), dim) = -weights[k] * direction.head(dim);
  return row;
}

/// Gap, slip and their gradients, given the frame.
void fill(ContactLinearisation &out, std::span<const double> impactor, std::span<const double> target,
          std::span<const double> weights, std::span<const double> displacement, std::span<const double> slip_origin)
{
  const int dim = out.dim;
  const auto d = static_cast<std::size_t>(dim);
  AMONTONS_ASSERT(impactor.size() == d && slip_origin.size() == d && target.size() == d * weights.size() &&
                  displacement.size() == d * (1 + weights.size()));
  const auto vector = [](std::span<const double> v)
  { return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())); };
  const auto u = vector(displacement), origin = vector(slip_origin);
  out.gap_gradient = relative_row(dim, out.normal, weights);
  out.gap = out.gap_gradient.head(dim).dot(vector(impactor)) +
            out.gap_gradient.tail(target.size()).dot(vector(target)) + out.gap_gradient.dot(u);
  out.gap_direction = out.gap_gradient;
  for (int c = 0; c < dim - 1; ++c)
  {
    out.slip_gradient[c] = relative_row(dim, out.tangent[c], weights);
    out.slip[c] = out.slip_gradient[c].dot(u) - out.tangent[c].head(dim).dot(origin);
    out.slip_direction[c] = out.slip_gradient[c];
  }
}

template<int dim>
void set_frame(ContactLinearisation &out, const Frame<double, dim> &frame)
{
  out.dim = dim;
  out.normal.head<dim>() = frame.normal;
  for (int c = 0; c < dim - 1; ++c)
  {
    out.tangent[c].setZero();
    out.tangent[c].head<dim>() = frame.tangent[c];
  }
}

template<int dim, int n_nodes>
ContactLinearisation linearise(std::span<const double> impactor, std::span<const double> face,
                               std::span<const double> displacement, std::span<const double> slip_origin,
                               std::array<double, 2> xi)
{
  const auto nodes = gather<dim, n_nodes>(face);
  const auto shape = shape_functions<n_nodes>(Chart{}, xi);
  std::array<Point<double, dim>, dim - 1> base;
  for (int a = 0; a < dim - 1; ++a)
    base[a] = combine(shape.derivative[a], nodes);
  ContactLinearisation out;
  out.xi = xi;
  set_frame<dim>(out, frame_of<double, dim>(base));
  fill(out, impactor, face, shape.value, displacement, slip_origin);
  return out;
}
} // namespace

ContactLinearisation linearise_small(int dim, std::span<const double> reference_impactor,
                                     std::span<const double> reference_face, std::span<const double> displacement,
                                     std::span<const double> slip_origin, std::array<double, 2> xi)
{
  if (dim == 2 && reference_face.size() == 4)
    return linearise<2, 2>(reference_impactor, reference_face, displacement, slip_origin, xi);
  if (dim == 3 && reference_face.size() == 9)
    return linearise<3, 3>(reference_impactor, reference_face, displacement, slip_origin, xi);
  AMONTONS_ASSERT(dim == 3 && reference_face.size() == 12);
  return linearise<3, 4>(reference_impactor, reference_face, displacement, slip_origin, xi);
}

ContactLinearisation linearise_mean(int dim, const Eigen::Vector3d &normal, std::span<const double> reference_impactor,
                                    std::span<const double> reference_targets, std::span<const double> weights,
                                    std::span<const double> displacement, std::span<const double> slip_origin)
{
  ContactLinearisation out;
  if (dim == 2)
    set_frame<2>(out, frame_from<double, 2>(normal.head<2>(), {}));
  else
    set_frame<3>(out, frame_from<double, 3>(normal, farthest_axis(normal)));
  fill(out, reference_impactor, reference_targets, weights, displacement, slip_origin);
  return out;
}
} // namespace amontons
