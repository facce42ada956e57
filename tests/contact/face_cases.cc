#include "amontons/contact/kinematics.h"
#include "amontons/surface/quadrilateral.h"
#include "measures.h"

namespace amontons::test
{
using Eigen::Vector3d;
using Eigen::VectorXcd;
using Eigen::VectorXd;

namespace
{
/// Shape functions as textbooks give them; beyond a quadrilateral's reach linear about `centre`.
struct Interpolation
{
  int n_nodes;
  bool linear_about_centre = false;
  LocalPoint centre{0, 0};

  [[nodiscard]] std::vector<Jet> at(const std::array<Jet, 2> &xi) const
  {
    if (n_nodes == 2)
      return {Jet(1) - xi[0], xi[0]};
    if (n_nodes == 3)
      return {Jet(1) - xi[0] - xi[1], xi[0], xi[1]};
    if (!linear_about_centre)
      return {(Jet(1) - xi[0]) * (Jet(1) - xi[1]), xi[0] * (Jet(1) - xi[1]), xi[0] * xi[1], (Jet(1) - xi[0]) * xi[1]};
    const Interpolation own{4};
    auto out = own.at({centre[0], centre[1]});
    const auto slope0 = own.slope({centre[0], centre[1]}, 0), slope1 = own.slope({centre[0], centre[1]}, 1);
    for (int i = 0; i < 4; ++i)
      out[i] = out[i] + slope0[i] * (xi[0] - centre[0]) + slope1[i] * (xi[1] - centre[1]);
    return out;
  }
  /// All interpolations are linear in each coordinate by itself.
  [[nodiscard]] std::vector<Jet> slope(std::array<Jet, 2> xi, int a) const
  {
    xi[a] = linear_about_centre ? Jet(centre[a] + 1) : Jet(1);
    const auto high = at(xi);
    xi[a] = linear_about_centre ? Jet(centre[a]) : Jet(0);
    const auto low = at(xi);
    std::vector<Jet> out;
    out.reserve(high.size());
    for (std::size_t i = 0; i < high.size(); ++i)
      out.push_back(high[i] - low[i]);
    return out;
  }
};

JetPoint sum(const std::vector<Jet> &weights, const std::vector<JetPoint> &points)
{
  JetPoint out = weights[0] * points[0];
  for (std::size_t i = 1; i < points.size(); ++i)
    out = out + weights[i] * points[i];
  return out;
}

/// Closest point by Newton's method, whole, in jets: each step adds an order of derivatives.
std::array<Jet, 2> solve_projection(int n_xi, const Interpolation &interpolation, const JetPoint &x,
                                    const std::vector<JetPoint> &face, std::array<Jet, 2> xi)
{
  for (int step = 0; step < 14; ++step)
  {
    const JetPoint offset = x - sum(interpolation.at(xi), face);
    std::array<JetPoint, 2> base;
    for (int a = 0; a < n_xi; ++a)
      base[a] = sum(interpolation.slope(xi, a), face);
    if (n_xi == 1)
    {
      xi[0] = xi[0] + dot(offset, base[0]) / dot(base[0], base[0]);
      continue;
    }
    JetPoint twist; // x_,12 = x_,1 at xi2 = 1 less that at xi2 = 0
    if (interpolation.n_nodes == 4 && !interpolation.linear_about_centre)
      twist = (face[0] - face[1]) + (face[2] - face[3]);
    const Jet m11 = dot(base[0], base[0]), m22 = dot(base[1], base[1]),
              m12 = dot(base[0], base[1]) - dot(offset, twist);
    const Jet r1 = dot(offset, base[0]), r2 = dot(offset, base[1]), det = m11 * m22 - m12 * m12;
    xi = {xi[0] + (m22 * r1 - m12 * r2) / det, xi[1] + (m11 * r2 - m12 * r1) / det};
  }
  return xi;
}

/// The geometry of a face element.
struct FaceSetting
{
  int dim;
  int n_nodes;
  Interpolation interpolation;
  std::array<Jet, 2> start;
  VectorXd slip_origin;
  VectorXd face_at_start;
};

template<class Vector>
std::vector<JetPoint> face_of(int dim, int n_nodes, const Vector &x, int first)
{
  std::vector<JetPoint> face;
  face.reserve(n_nodes);
  for (int i = 0; i < n_nodes; ++i)
    face.push_back(jet_node(dim, x, first + i));
  return face;
}

/// Values alone, as constants.
Jet frozen(const Jet &a)
{
  return {a.value.real()};
}

Measured measure_finite(const FaceSetting &s, const VectorXcd &dofs)
{
  const int n_xi = s.dim - 1;
  const JetPoint x = jet_node(s.dim, dofs, 0);
  const auto face = face_of(s.dim, s.n_nodes, dofs, 1);
  const auto xi = solve_projection(n_xi, s.interpolation, x, face, s.start);
  auto alpha = solve_projection(n_xi, Interpolation{s.n_nodes}, jet_node(s.dim, s.slip_origin, 0),
                                face_of(s.dim, s.n_nodes, s.face_at_start, 0), {0.5, 0.5});
  alpha = {frozen(alpha[0]), frozen(alpha[1])};

  std::array<JetPoint, 2> base;
  for (int a = 0; a < n_xi; ++a)
    base[a] = sum(s.interpolation.slope(xi, a), face);
  const JetPoint normal = s.dim == 2 ? unit({base[0][1], -base[0][0], Jet(0)}) : unit(cross(base[0], base[1]));
  const JetPoint closest = sum(s.interpolation.at(xi), face);
  const Jet gap = dot(x - closest, normal);
  const auto e = tangents(s.dim, normal, base[0]);
  Measured out{gap.value, gap.gradient, {}, {}, {}};
  for (int c = 0; c < n_xi; ++c)
  {
    set_slip(out, c, dot(e[c], closest - sum(Interpolation{s.n_nodes}.at(alpha), face)));
    out.slip_direction[c].setZero();
    for (int a = 0; a < n_xi; ++a)
      out.slip_direction[c] += dot(e[c], base[a]).value * xi[a].gradient;
  }
  return out;
}

/// Nodes of a face of unit size, distorted (and warped) at random, in a random attitude.
VectorXd random_face(Random &random, int dim, int n_nodes, double warp)
{
  Eigen::MatrixXd flat(3, n_nodes);
  if (n_nodes == 2)
    flat << 0, 1, 0, 0, 0, 0;
  else if (n_nodes == 3)
    flat << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  else
    flat << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  for (int i = 0; i < n_nodes; ++i)
    flat.col(i) += Vector3d(uniform(random, -.15, .15), uniform(random, -.15, .15), uniform(random, -warp, warp));
  const Eigen::MatrixXd placed = random_rotation(random, dim) * flat;
  VectorXd out(dim * n_nodes);
  for (int i = 0; i < n_nodes; ++i)
    out.segment(dim * i, dim) = placed.col(i).head(dim);
  return out;
}

/// A point at given local coordinates and about the given height above a face.
VectorXd point_above(int dim, int n_nodes, const VectorXd &face, std::array<double, 2> xi, double height)
{
  const auto jets = face_of(dim, n_nodes, face, 0);
  const Interpolation own{n_nodes};
  const std::array<Jet, 2> at{xi[0], xi[1]};
  const JetPoint foot = sum(own.at(at), jets), a = sum(own.slope(at, 0), jets);
  const JetPoint n = dim == 2 ? unit({a[1], -a[0], Jet(0)}) : unit(cross(a, sum(own.slope(at, 1), jets)));
  VectorXd out(dim);
  for (int k = 0; k < dim; ++k)
    out[k] = (foot[k].value + height * n[k].value).real();
  return out;
}

} // namespace

Case finite_case(int dim, int n_nodes, bool beyond, unsigned seed, bool with_slip)
{
  Random random(seed);
  const VectorXd face = random_face(random, dim, n_nodes, beyond ? 0.03 : 0.15);
  const std::array<double, 2> xi{beyond ? uniform(random, 2.6, 3) : uniform(random, -.1, .8),
                                 uniform(random, beyond ? .2 : -.1, .7)};
  const VectorXd x = point_above(dim, n_nodes, face, xi, uniform(random, -.1, .1));
  FaceSetting setting{dim, n_nodes, {n_nodes}, {xi[0], xi[1]}, x, face};
  if (beyond)
  {
    const Vector3d at = x;
    FaceCoordinates coordinates{4, {}};
    for (int i = 0; i < 4; ++i)
      coordinates.x[i] = face.segment<3>(3 * i);
    setting.interpolation = {4, true, closest_point_by_quintic(coordinates, at).xi};
  }
  if (with_slip || beyond)
  {
    setting.face_at_start = face + 0.05 * random_vector(random, dim * n_nodes);
    setting.slip_origin =
        point_above(dim, n_nodes, setting.face_at_start, {uniform(random, .1, .5), uniform(random, .1, .4)}, 0.01);
  }
  Case out{dim, VectorXd(dim * (1 + n_nodes)), {}, {}};
  out.x << x, face;
  out.linearise = [=](const VectorXd &dofs)
  {
    return linearise_finite(dim, span(dofs.head(dim)), span(dofs.tail(dim * n_nodes)), span(setting.slip_origin),
                            span(setting.face_at_start), {0.4, 0.4});
  };
  out.measure = [=](const VectorXcd &dofs) { return measure_finite(setting, dofs); };
  return out;
}

namespace
{
Measured measure_small(int dim, int n_nodes, const VectorXd &reference, const VectorXd &origin,
                       std::array<double, 2> xi, const VectorXcd &u)
{
  const auto face = face_of(dim, n_nodes, reference, 1);
  const Interpolation own{n_nodes};
  const std::array<Jet, 2> at{xi[0], xi[1]};
  std::array<JetPoint, 2> base;
  for (int a = 0; a < dim - 1; ++a)
    base[a] = sum(own.slope(at, a), face);
  for (auto &point : base)
    for (auto &component : point)
      component = frozen(component);
  const JetPoint normal = dim == 2 ? unit({base[0][1], -base[0][0], Jet(0)}) : unit(cross(base[0], base[1]));
  const JetPoint jump = jet_node(dim, u, 0) - sum(own.at(at), face_of(dim, n_nodes, u, 1));
  JetPoint offset = jet_node(dim, reference, 0) - sum(own.at(at), face);
  for (auto &component : offset)
    component = frozen(component);
  const Jet gap = dot(normal, offset + jump);
  const auto e = tangents(dim, normal, base[0]);
  Measured out{gap.value, gap.gradient, {}, {}, {}};
  Vector3d start = Vector3d::Zero();
  start.head(dim) = origin;
  for (int c = 0; c < dim - 1; ++c)
  {
    const Jet slip = dot(e[c], jump - constant(start));
    set_slip(out, c, slip);
    out.slip_direction[c] = slip.gradient;
  }
  return out;
}

} // namespace

Case small_case(int dim, int n_nodes, unsigned seed, bool with_slip)
{
  Random random(seed);
  const VectorXd face = random_face(random, dim, n_nodes, 0.15);
  const std::array<double, 2> xi{uniform(random, -.1, .8), uniform(random, -.1, .7)};
  const VectorXd impactor = point_above(dim, n_nodes, face, xi, uniform(random, -.1, .1));
  VectorXd reference(dim * (1 + n_nodes));
  reference << impactor, face;
  Case out{dim, 0.1 * random_vector(random, dim * (1 + n_nodes)), {}, {}};
  VectorXd origin = 0.1 * random_vector(random, dim);
  if (!with_slip)
  {
    const Interpolation own{n_nodes};
    const JetPoint jump = jet_node(dim, out.x, 0) - sum(own.at({xi[0], xi[1]}), face_of(dim, n_nodes, out.x, 1));
    for (int k = 0; k < dim; ++k)
      origin[k] = jump[k].value.real();
  }
  out.linearise = [=](const VectorXd &u)
  { return linearise_small(dim, span(impactor), span(face), span(u), span(origin), xi); };
  out.measure = [=](const VectorXcd &u) { return measure_small(dim, n_nodes, reference, origin, xi, u); };
  return out;
}
} // namespace amontons::test
