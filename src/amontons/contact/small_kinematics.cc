#include "amontons/base/error.h"
#include "amontons/contact/face.h"
#include "amontons/contact/kinematics.h"

namespace amontons
{
namespace
{
/// e.(u_1 - sum N_i u_i) as a row: (e, -N_1 e, ..., -N_n e).
template<int dim, int n_nodes>
ContactVector relative_row(const Point<double, dim> &direction, const std::array<double, n_nodes> &shape)
{
  ContactVector row(dim * (1 + n_nodes));
  row.head<dim>() = direction;
  for (int i = 0; i < n_nodes; ++i)
    row.segment<dim>(dim * (1 + i)) = -shape[i] * direction;
  return row;
}

template<int dim, int n_nodes>
ContactLinearisation linearise(std::span<const double> impactor, std::span<const double> face_coordinates,
                               std::span<const double> displacement, std::span<const double> slip_origin,
                               std::array<double, 2> xi)
{
  constexpr int n_dofs = dim * (1 + n_nodes);
  AMONTONS_ASSERT(impactor.size() == dim && slip_origin.size() == dim && displacement.size() == n_dofs);
  const auto nodes = gather<dim, n_nodes>(face_coordinates);
  const auto shape = shape_functions<n_nodes>(Chart{}, xi);
  std::array<Point<double, dim>, dim - 1> base;
  for (int a = 0; a < dim - 1; ++a)
    base[a] = combine(shape.derivative[a], nodes);
  const auto frame = frame_of<double, dim>(base);
  const Eigen::Map<const Point<double, dim>> x(impactor.data()), origin(slip_origin.data());
  const Eigen::Map<const Point<double, n_dofs>> u(displacement.data());

  ContactLinearisation out;
  out.dim = dim;
  out.xi = xi;
  out.normal.head<dim>() = frame.normal;
  out.gap_gradient = relative_row<dim, n_nodes>(frame.normal, shape.value);
  out.gap = (x - combine(shape.value, nodes)).dot(frame.normal) + out.gap_gradient.dot(u);
  out.gap_direction = out.gap_gradient;
  out.gap_direction_gradient.setZero(n_dofs, n_dofs);
  for (int c = 0; c < dim - 1; ++c)
  {
    out.tangent[c].setZero();
    out.tangent[c].head<dim>() = frame.tangent[c];
    out.slip_gradient[c] = relative_row<dim, n_nodes>(frame.tangent[c], shape.value);
    out.slip[c] = out.slip_gradient[c].dot(u) - frame.tangent[c].dot(origin);
    out.slip_direction[c] = out.slip_gradient[c];
    out.slip_direction_gradient[c].setZero(n_dofs, n_dofs);
  }
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
} // namespace amontons
