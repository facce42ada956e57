#include "amontons/surface/overlap_integrals.h"

#include "amontons/surface/segment_overlap.h"

#include <numbers>

namespace amontons
{
namespace
{
using Eigen::Vector3d;
constexpr int n_plane_variables = 12; // the impactor's nodes, its normals, the target's nodes

/// A segment (or the two normals) as variables from number `first` on.
template<class Scalar>
Segment<Scalar> variables(const Vector3d &start, const Vector3d &end, int first)
{
  Segment<Scalar> out;
  for (int c = 0; c < 2; ++c)
    if constexpr (std::is_same_v<Scalar, double>)
    {
      out.start[c] = start[c];
      out.end[c] = end[c];
    }
    else
    {
      out.start[c] = Scalar::variable(start[c], first + c);
      out.end[c] = Scalar::variable(end[c], first + 2 + c);
    }
  return out;
}

void store(double value, int i, int k, Eigen::Matrix4d &integrals, OverlapIntegrals::Gradient &)
{
  integrals(i, k) = value;
}

void store(const Dual<n_plane_variables> &value, int i, int k, Eigen::Matrix4d &integrals,
           OverlapIntegrals::Gradient &gradient)
{
  constexpr int n_own = 8, n_target = 4;
  const Eigen::Map<const Eigen::RowVectorXd> by(value.gradient.data(), n_plane_variables);
  integrals(i, k) = value.value;
  gradient.row(4 * i + k).head<n_own>() = by.head<n_own>();
  gradient.row(4 * i + k).segment<n_target>(OverlapIntegrals::n_own) = by.tail<n_target>();
}

template<class Scalar>
void integrate(const FaceCoordinates &impactor, const std::array<Vector3d, 2> &normals, const FaceCoordinates &target,
               bool axisymmetric, OverlapIntegrals &out)
{
  const auto own = variables<Scalar>(impactor.x[0], impactor.x[1], 0);
  using Pairs = std::array<std::array<Scalar, 2>, 2>;
  Pairs mass{}, mixed{};
  const auto add = [&](const SegmentPoint<Scalar> &point)
  {
    Scalar weight = point.weight;
    if (axisymmetric)
      weight *= 2 * std::numbers::pi * (own.start[0] + point.xi * (own.end[0] - own.start[0]));
    const std::array<Scalar, 2> mine{1. - point.xi, point.xi}, others{1. - point.eta, point.eta};
    out.ring_size += value_of(weight);
    out.least_gap = std::min(out.least_gap, std::abs(point.gap));
    for (std::size_t i = 0; i < 2; ++i)
    {
      const Scalar weighted = weight * mine[i];
      for (std::size_t k = 0; k < 2; ++k)
      {
        mass[i][k] += weighted * mine[k];
        mixed[i][k] += weighted * others[k];
      }
    }
  };
  out.size = value_of(visit_overlap<Scalar>(own, variables<Scalar>(normals[0], normals[1], 4),
                                            variables<Scalar>(target.x[0], target.x[1], 8), add));
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
    {
      store(mass[i][k], i, k, out.mass, out.mass_gradient);
      store(mixed[i][k], i, k, out.mixed, out.mixed_gradient);
    }
}
} // namespace

void integrate_overlap(const FaceCoordinates &impactor, const std::array<Vector3d, 2> &normals,
                       const FaceCoordinates &target, bool axisymmetric, bool with_gradient, OverlapIntegrals &out)
{
  out.reset(with_gradient);
  if (with_gradient)
    integrate<Dual<n_plane_variables>>(impactor, normals, target, axisymmetric, out);
  else
    integrate<double>(impactor, normals, target, axisymmetric, out);
}
} // namespace amontons
