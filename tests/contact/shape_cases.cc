#include "amontons/contact/kinematics.h"
#include "measures.h"

namespace amontons::test
{
using Eigen::Vector3d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace
{
/// Signed distance and frame of a shape at p, from the definition of each.
struct ShapeMeasure
{
  Jet gap;
  JetPoint normal;
  JetPoint along; ///< e_1
};

ShapeMeasure measure_shape(int dim, bool axisymmetric, const Shape &shape, const JetPoint &p)
{
  const JetPoint axis{shape.axis[0], shape.axis[1], shape.axis[2]};
  const JetPoint across = p - dot(p, axis) * axis;
  const Jet rho = axisymmetric ? p[0] : sqrt(dot(across, across));
  ShapeMeasure out;
  if (shape.type == ShapeType::plane)
    out = {dot(p, axis), axis, {}};
  else if (shape.type == ShapeType::circle || shape.type == ShapeType::sphere)
    out = {sqrt(dot(p, p)) - shape.radius, unit(p), {}};
  else if (shape.type == ShapeType::cylinder)
    out = {rho - shape.radius, axisymmetric ? JetPoint{1., 0., 0.} : unit(across), axis};
  else
  {
    // From the angle between p and the axis: gap = |p| sin(angle - half angle).
    const Jet h = dot(p, axis), ca = std::cos(shape.half_angle), sa = std::sin(shape.half_angle);
    const JetPoint outward = axisymmetric ? JetPoint{1., 0., 0.} : unit(across);
    out = {rho * ca - h * sa, ca * outward - sa * axis, {}};
    out.along = unit(p - out.gap * out.normal);
  }
  if (dim == 2)
    out.along = {-out.normal[1], out.normal[0], Jet(0)};
  return out;
}

Shape random_shape(Random &random, ShapeType type, bool axisymmetric, int dim)
{
  Shape shape{type, {0, 0, 0}, {0, 1, 0}, uniform(random, .8, 1.5), uniform(random, .5, 1.2)};
  const Vector3d axis = random_rotation(random, dim) * Vector3d(0, 1, 0);
  if (!axisymmetric)
    shape.axis = {axis[0], axis[1], axis[2]};
  return shape;
}

/// e_1 of a plane and of a sphere is the library's choice: taken from it, then carried along by its own rule.
JetPoint chosen_tangent(const Shape &shape, const ContactLinearisation &at, const JetPoint &normal)
{
  if (shape.type == ShapeType::plane)
    return constant(at.tangent[0]);
  const JetPoint direction = constant(Vector3d(0.8113, 0.4729, 0.3437).normalized());
  return unit(direction - dot(direction, normal) * normal);
}

VectorXd shape_impactor(Random &random, const Shape &shape, int dim, bool axisymmetric)
{
  VectorXd p = random_vector(random, dim);
  if (axisymmetric)
    p[0] = uniform(random, .5, 1);
  if (shape.type == ShapeType::cone) // near the cone's flank, away from its apex
    p += 2 * Eigen::Map<const VectorXd>(shape.axis.data(), dim);
  return p;
}

} // namespace

Case shape_case(int dim, ShapeType type, bool axisymmetric, bool small, unsigned seed, bool with_slip)
{
  Random random(seed);
  Shape shape = random_shape(random, type, axisymmetric, dim);
  const VectorXd impactor = shape_impactor(random, shape, dim, axisymmetric);
  VectorXd point = axisymmetric ? VectorXd(VectorXd::Zero(dim)) : random_vector(random, dim);
  if (small)
    for (int k = 0; k < dim; ++k)
      shape.point[k] = point[k];
  const VectorXd node = impactor + point;
  const VectorXd origin = with_slip ? VectorXd(0.1 * random_vector(random, dim)) : VectorXd(VectorXd::Zero(dim));
  Case out{dim, VectorXd(2 * dim), {}, {}};
  if (small)
    out.x = 0.1 * random_vector(random, 2 * dim);
  else
    out.x << node, point;
  const VectorXd start_point = small ? VectorXd(VectorXd::Zero(dim)) : VectorXd(random_vector(random, dim));
  const VectorXd jump = out.x.head(dim) - out.x.tail(dim);
  const VectorXd slip_origin = jump - origin + start_point;
  out.linearise = [=](const VectorXd &x)
  {
    return small ? linearise_shape_small(dim, axisymmetric, shape, span(node), span(x), span(slip_origin))
                 : linearise_shape(dim, axisymmetric, shape, span(x.head(dim)), span(x.tail(dim)), span(slip_origin),
                                   span(start_point));
  };
  const ContactLinearisation at = out.linearise(out.x);
  out.measure = [=](const VectorXcd &x)
  {
    const JetPoint p = jet_node(dim, x, 0) - jet_node(dim, x, 1);
    JetPoint place;
    for (int k = 0; k < dim; ++k)
      place[k] = small ? Jet(impactor[k]) : p[k];
    ShapeMeasure shape_at = measure_shape(dim, axisymmetric, shape, place);
    if (dim == 3 && (type == ShapeType::plane || type == ShapeType::sphere))
      shape_at.along = chosen_tangent(shape, at, shape_at.normal);
    const auto e = tangents(dim, shape_at.normal, shape_at.along);
    const Jet gap = small ? shape_at.gap + dot(shape_at.normal, p) : shape_at.gap;
    Measured measured{gap.value, gap.gradient, {}, {}, {}};
    Vector3d start = Vector3d::Zero();
    start.head(dim) = slip_origin - start_point;
    for (int c = 0; c < dim - 1; ++c)
    {
      set_slip(measured, c, dot(e[c], p - constant(start)));
      measured.slip_direction[c].setZero();
      for (int k = 0; k < dim; ++k)
      {
        measured.slip_direction[c][k] = e[c][k].value;
        measured.slip_direction[c][dim + k] = -e[c][k].value;
      }
    }
    return measured;
  };
  return out;
}
} // namespace amontons::test
