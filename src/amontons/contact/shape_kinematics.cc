#include "amontons/base/error.h"
#include "amontons/contact/face.h"
#include "amontons/contact/kinematics.h"
#include "amontons/surface/dual.h"

#include <cmath>

namespace amontons
{
namespace
{
template<class Scalar, int dim>
struct ShapeFrame
{
  Scalar gap;
  Frame<Scalar, dim> frame;
};

/// A direction along no axis of coordinates and no diagonal: tangents of a sphere are singular along it, so it is put
/// where hardly anyone presses.
template<int dim>
Point<double, dim> odd_direction()
{
  return Eigen::Vector3d(0.8113, 0.4729, 0.3437).normalized().template head<dim>();
}

template<class Scalar, int dim>
ShapeFrame<Scalar, dim> ball_frame(const Shape &shape, const Point<Scalar, dim> &p)
{
  const Scalar distance = norm<Scalar, dim>(p);
  if (!(value_of(distance) > 1e-12 * shape.radius))
    throw NumericalFailure("a contact node lies at the centre of a rigid " +
                           std::string(dim == 2 ? "circle" : "sphere"));
  const Point<Scalar, dim> along = odd_direction<dim>().template cast<Scalar>();
  return {distance - shape.radius, frame_from<Scalar, dim>(p * (1. / distance), along)};
}

template<class Scalar, int dim>
ShapeFrame<Scalar, dim> plane_frame(const Point<double, dim> &axis, const Point<Scalar, dim> &p)
{
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  n.head<dim>() = axis;
  const Point<double, dim> along = farthest_axis(n).head<dim>();
  return {p.dot(axis.template cast<Scalar>()),
          frame_from<Scalar, dim>(axis.template cast<Scalar>(), along.template cast<Scalar>())};
}

/// Cylinder and cone: a surface of revolution with straight generators at the half angle (0: the cylinder) to its axis.
/// In axisymmetry the axis is that of y and x the radius, so that the meridian is a straight line.
template<class Scalar, int dim>
ShapeFrame<Scalar, dim> revolved_frame(bool axisymmetric, const Shape &shape, const Point<double, dim> &axis,
                                       const Point<Scalar, dim> &p)
{
  const double half_angle = shape.type == ShapeType::cone ? shape.half_angle : 0;
  const double radius = shape.type == ShapeType::cone ? 0 : shape.radius;
  const double cosine = std::cos(half_angle), sine = std::sin(half_angle);
  const auto k = axis.template cast<Scalar>().eval();
  const Scalar height = p.dot(k);
  Point<Scalar, dim> radial = p - k * height;
  Scalar distance = axisymmetric ? radial[0] : norm<Scalar, dim>(radial);
  if (axisymmetric)
    radial = Point<double, dim>::Unit(0).template cast<Scalar>();
  else if (value_of(distance) > 1e-12 * std::abs(value_of(height)) && value_of(distance) > 1e-12 * radius)
    radial = radial * (1. / distance);
  else if (shape.type == ShapeType::cone) // Under the apex all sides are equally near: the axis gives the normal.
    return {-height, plane_frame<Scalar, dim>(-axis, p).frame};
  else
    throw NumericalFailure("a contact node lies on the axis of a rigid cylinder");
  const Point<Scalar, dim> normal = radial * cosine - k * sine;
  return {(distance - radius) * cosine - height * sine, frame_from<Scalar, dim>(normal, radial * sine + k * cosine)};
}

/// Signed distance of p, a position relative to the shape's point, and the frame at its closest point.
template<class Scalar, int dim>
ShapeFrame<Scalar, dim> shape_frame(bool axisymmetric, const Shape &shape, const Point<Scalar, dim> &p)
{
  const Point<double, dim> axis = Eigen::Map<const Point<double, dim>>(shape.axis.data());
  switch (shape.type)
  {
  case ShapeType::plane:
    return plane_frame<Scalar, dim>(axis, p);
  case ShapeType::circle:
  case ShapeType::sphere:
    return ball_frame<Scalar, dim>(shape, p);
  case ShapeType::cylinder:
  case ShapeType::cone:
    AMONTONS_ASSERT(dim == 3 || axisymmetric);
    return revolved_frame<Scalar, dim>(axisymmetric, shape, axis, p);
  }
  throw InternalError("unknown analytic shape");
}

/// The row (v, -v): what moves with the impactor less what moves with the shape.
template<int dim>
ContactVector opposed(const Point<double, dim> &v)
{
  ContactVector row(2 * dim);
  row << v, -v;
  return row;
}

/// d(v, -v)/d(x_1, x_shape), v a function of x_1 - x_shape.
template<int dim>
ContactMatrix opposed_gradient(const Point<Dual<dim>, dim> &v)
{
  ContactMatrix out(2 * dim, 2 * dim);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
    {
      out(i, j) = out(dim + i, dim + j) = v[i].gradient[j];
      out(i, dim + j) = out(dim + i, j) = -v[i].gradient[j];
    }
  return out;
}

template<int dim>
Point<double, dim> values(const Point<Dual<dim>, dim> &v)
{
  Point<double, dim> out;
  for (int k = 0; k < dim; ++k)
    out[k] = v[k].value;
  return out;
}

template<int dim>
using ConstPoint = Eigen::Map<const Point<double, dim>>;

template<int dim>
ContactLinearisation linearise(bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                               std::span<const double> shape_point, std::span<const double> slip_origin,
                               std::span<const double> shape_point_at_start)
{
  AMONTONS_ASSERT(impactor.size() == dim && shape_point.size() == dim);
  AMONTONS_ASSERT(slip_origin.size() == dim && shape_point_at_start.size() == dim);
  Point<Dual<dim>, dim> p;
  for (int k = 0; k < dim; ++k)
    p[k] = Dual<dim>::variable(impactor[k] - shape_point[k], k);
  const auto [gap, frame] = shape_frame<Dual<dim>, dim>(axisymmetric, shape, p);
  const Point<double, dim> start = ConstPoint<dim>(slip_origin.data()) - ConstPoint<dim>(shape_point_at_start.data());
  const Point<Dual<dim>, dim> chord = p - start.template cast<Dual<dim>>();

  ContactLinearisation out;
  out.dim = dim;
  out.gap = gap.value;
  out.normal.template head<dim>() = values<dim>(frame.normal);
  out.gap_gradient = opposed<dim>(values<dim>(frame.normal));
  out.gap_direction = out.gap_gradient;
  out.gap_direction_gradient = opposed_gradient<dim>(frame.normal);
  for (int c = 0; c < dim - 1; ++c)
  {
    const Dual<dim> slip = chord.dot(frame.tangent[c]);
    out.tangent[c].setZero();
    out.tangent[c].template head<dim>() = values<dim>(frame.tangent[c]);
    out.slip[c] = slip.value;
    out.slip_gradient[c] = opposed<dim>(ConstPoint<dim>(slip.gradient.data()));
    out.slip_direction[c] = opposed<dim>(values<dim>(frame.tangent[c]));
    out.slip_direction_gradient[c] = opposed_gradient<dim>(frame.tangent[c]);
  }
  return out;
}

template<int dim>
ContactLinearisation linearise_reference(bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                                         std::span<const double> displacement, std::span<const double> slip_origin)
{
  AMONTONS_ASSERT(impactor.size() == dim && displacement.size() == 2 * dim && slip_origin.size() == dim);
  const Point<double, dim> p = ConstPoint<dim>(impactor.data()) - ConstPoint<dim>(shape.point.data());
  const auto [gap, frame] = shape_frame<double, dim>(axisymmetric, shape, p);
  const Point<double, dim> relative = ConstPoint<dim>(displacement.data()) - ConstPoint<dim>(displacement.data() + dim);

  ContactLinearisation out;
  out.dim = dim;
  out.gap = gap + frame.normal.dot(relative);
  out.normal.template head<dim>() = frame.normal;
  out.gap_gradient = opposed<dim>(frame.normal);
  out.gap_direction = out.gap_gradient;
  for (int c = 0; c < dim - 1; ++c)
  {
    out.tangent[c].setZero();
    out.tangent[c].template head<dim>() = frame.tangent[c];
    out.slip[c] = frame.tangent[c].dot(relative - ConstPoint<dim>(slip_origin.data()));
    out.slip_gradient[c] = opposed<dim>(frame.tangent[c]);
    out.slip_direction[c] = out.slip_gradient[c];
  }
  return out;
}

template<int dim>
Eigen::Vector3d closing_origin(bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                               std::span<const double> shape_point, std::span<const double> impactor_at_start,
                               std::span<const double> shape_point_at_start)
{
  const Point<double, dim> now = ConstPoint<dim>(impactor.data()) - ConstPoint<dim>(shape_point.data());
  const Point<double, dim> start =
      ConstPoint<dim>(impactor_at_start.data()) - ConstPoint<dim>(shape_point_at_start.data());
  const double fraction = closing_fraction(shape_frame<double, dim>(axisymmetric, shape, start).gap,
                                           shape_frame<double, dim>(axisymmetric, shape, now).gap);
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  origin.head<dim>() = ConstPoint<dim>(impactor_at_start.data()) + fraction * (now - start);
  return origin;
}
} // namespace

ContactLinearisation linearise_shape(int dim, bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                                     std::span<const double> shape_point, std::span<const double> slip_origin,
                                     std::span<const double> shape_point_at_start)
{
  const auto linearise_in = dim == 2 ? linearise<2> : linearise<3>;
  return linearise_in(axisymmetric, shape, impactor, shape_point, slip_origin, shape_point_at_start);
}

ContactLinearisation linearise_shape_small(int dim, bool axisymmetric, const Shape &shape,
                                           std::span<const double> reference_impactor,
                                           std::span<const double> displacement, std::span<const double> slip_origin)
{
  const auto linearise_in = dim == 2 ? linearise_reference<2> : linearise_reference<3>;
  return linearise_in(axisymmetric, shape, reference_impactor, displacement, slip_origin);
}

Eigen::Vector3d closing_origin_shape(int dim, bool axisymmetric, const Shape &shape, std::span<const double> impactor,
                                     std::span<const double> shape_point, std::span<const double> impactor_at_start,
                                     std::span<const double> shape_point_at_start)
{
  const auto closing_origin_in = dim == 2 ? closing_origin<2> : closing_origin<3>;
  return closing_origin_in(axisymmetric, shape, impactor, shape_point, impactor_at_start, shape_point_at_start);
}
} // namespace amontons
