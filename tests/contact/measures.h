#pragma once
#include "amontons/surface/shape.h"
#include "cases.h"

#include <span>

/// What the independent measures of faces and of shapes share.
namespace amontons::test
{
inline std::span<const double> span(const Eigen::VectorXd &v)
{
  return {v.data(), static_cast<std::size_t>(v.size())};
}

/// Node i of the dofs as a jet whose gradient is with respect to the dofs.
inline JetPoint jet_node(int dim, const Eigen::VectorXcd &x, int node)
{
  JetPoint out;
  for (int k = 0; k < dim; ++k)
  {
    out[k] = Jet(x[dim * node + k], Jet::Gradient::Unit(dim * node + k));
  }
  return out;
}

inline JetPoint jet_node(int dim, const Eigen::VectorXd &x, int node)
{
  return jet_node(dim, Eigen::VectorXcd(x.cast<Complex>()), node);
}

inline void set_slip(Measured &out, int c, const Jet &slip)
{
  out.slip[c] = slip.value;
  out.slip_gradient[c] = slip.gradient;
}

inline std::array<JetPoint, 2> tangents(int dim, const JetPoint &normal, const JetPoint &along)
{
  if (dim == 2)
    return {unit(along), {}};
  const JetPoint e1 = unit(along);
  return {e1, cross(normal, e1)};
}

/// @param beyond so far out that the tangent plane stands in for a quadrilateral
Case finite_case(int dim, int n_nodes, bool beyond, unsigned seed, bool with_slip);
Case small_case(int dim, int n_nodes, unsigned seed, bool with_slip);
Case shape_case(int dim, ShapeType type, bool axisymmetric, bool small, unsigned seed, bool with_slip);
} // namespace amontons::test
