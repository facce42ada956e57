#include "detection/scene.h"

#include "amontons/base/error.h"
#include "amontons/detection/search_distance.h"
#include "surface/surfaces.h"

#include <Eigen/Dense>

#include <functional>
#include <map>

namespace amontons::benchmark
{
namespace
{
using Eigen::Vector3d;
using Map = std::function<Vector3d(double, double)>; ///< of the unit square; in 2D the second coordinate is not used

constexpr double turn = 2 * std::numbers::pi;

struct Kind
{
  Map map;
  double ratio = 1; ///< number of faces along the first direction over the second's
  bool closed = false;
  bool shuffled = false;
  double thickness = 0; ///< of a thin shell, in units of the mean edge
};

double graded(double s, double ratio)
{
  return std::expm1(std::log(ratio) * s) / (ratio - 1);
}

Vector3d turned(double x, double y)
{
  const double c = std::sqrt(0.5);
  const Vector3d about_z(c * (x - y), c * (x + y), 0);
  return {c * about_z.x(), about_z.y(), c * about_z.x()};
}

Vector3d turned_line(double s)
{
  return std::sqrt(0.5) * Vector3d(-s, -s, 0);
}

std::map<std::string, Kind> kinds_2d()
{
  const auto graded_line = [](double ratio)
  { return Map([ratio](double s, double) { return Vector3d(-graded(s, ratio), 0.1 * s * s, 0); }); };
  const Map wavy = [](double s, double) { return Vector3d(-s, 0.05 * std::sin(30 * s), 0); };
  return {
      {"wavy", {wavy}},
      {"shuffled", {wavy, 1, false, true}},
      {"circle", {[](double s, double) { return Vector3d(std::cos(turn * s), -std::sin(turn * s), 0); }, 1, true}},
      {"graded-50", {graded_line(50)}},
      {"graded-500", {graded_line(500)}},
      {"flat", {[](double s, double) { return Vector3d(-s, 0, 0); }}},
      {"flat-45", {[](double s, double) { return turned_line(s); }}},
      {"thin",
       {[](double s, double) { return Vector3d(std::cos(turn * s), std::sin(turn * s), 0); }, 1, true, false, 0.5}},
  };
}

std::map<std::string, Kind> kinds_3d()
{
  const auto graded_sheet = [](double ratio)
  {
    return Map(
        [ratio](double s, double t)
        {
          const double x = graded(s, ratio), y = graded(t, ratio);
          return Vector3d(x, y, 0.2 * x * y);
        });
  };
  const Map wavy = [](double s, double t) { return Vector3d(s, t, 0.05 * std::sin(20 * s) * std::cos(15 * t)); };
  const Map torus = [](double s, double t)
  {
    const test::Point x = test::torus(s, t, 1, 0.4);
    return Vector3d(x[0], x[1], x[2]);
  };
  return {
      {"wavy", {wavy}},
      {"shuffled", {wavy, 1, false, true}},
      {"torus", {torus, 2.5, true}},
      {"graded-50", {graded_sheet(50)}},
      {"graded-500", {graded_sheet(500)}},
      {"aspect-20", {wavy, 1.0 / 20}},
      {"flat", {[](double s, double t) { return Vector3d(s, t, 0); }}},
      {"flat-45", {[](double s, double t) { return turned(s, t); }}},
      {"thin", {torus, 2.5, true, false, 0.5}},
  };
}

// Presses a closed surface flat, to a thickness of a fraction of its mean edge.
Map pressed(const Kind &kind, int axis, double height, double edge)
{
  const double factor = kind.thickness * edge / height;
  return [map = kind.map, axis, factor](double s, double t)
  {
    Vector3d x = map(s, t);
    x[axis] *= factor;
    return x;
  };
}

struct Size
{
  int n, m; ///< faces along the two directions; m = 1 in 2D
};

// The area that falls to a face, times the normal.
Vector3d area_vector(const Map &map, double s, double t, int dim, Size size)
{
  constexpr double step = 1e-6;
  const Vector3d a = (map(s + step, t) - map(s - step, t)) / (2 * step) / size.n;
  const Vector3d b =
      dim == 2 ? Vector3d(0, 0, 1) : Vector3d((map(s, t + step) - map(s, t - step)) / (2 * step) / size.m);
  return a.cross(b);
}

// The map, moved along its normal by a wavy gap.
Map offset(const Map &map, int dim, Size size, double greatest)
{
  return [=](double s, double t)
  {
    const Vector3d area = area_vector(map, s, t, dim, size);
    const double local = std::min(dim == 2 ? area.norm() : std::sqrt(area.norm()), greatest);
    const double gap = local * (0.3 + 0.5 * std::sin(turn * 7 * s + 3) * std::cos(turn * 5 * t));
    return Vector3d(map(s, t) + gap * area.normalized());
  };
}

Surface mesh(const Map &map, int dim, Size size, bool triangles, bool closed)
{
  if (dim == 2)
    return test::curve(
        size.n,
        [&map](double s)
        {
          const Vector3d x = map(s, 0);
          return std::array<double, 2>{x.x(), x.y()};
        },
        closed);
  return test::sheet(
      size.n, size.m, triangles,
      [&map](double s, double t)
      {
        const Vector3d x = map(s, t);
        return test::Point{x.x(), x.y(), x.z()};
      },
      closed);
}

// Bodies that touch have normals against each other.
void turn_over(Surface &surface)
{
  for (Index f = 0; f < surface.n_faces(); ++f)
    std::reverse(surface.face_nodes.begin() + surface.face_offsets[f],
                 surface.face_nodes.begin() + surface.face_offsets[f + 1]);
}

double largest_gap(const Map &near, const Map &map, int dim, Size size)
{
  double gap = 0;
  const int n = std::min(size.n, 400), m = dim == 2 ? 0 : std::min(size.m, 400);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j)
    {
      const double s = static_cast<double>(i) / n, t = m > 0 ? static_cast<double>(j) / m : 0.0;
      gap = std::max(gap, (near(s, t) - map(s, t)).norm());
    }
  return gap;
}
} // namespace

std::vector<std::string> scene_surfaces(int dim)
{
  std::vector<std::string> names;
  for (const auto &[name, kind] : dim == 2 ? kinds_2d() : kinds_3d())
    names.push_back(name);
  return names;
}

Scene make_scene(const std::string &surface, const std::string &shape, double n_nodes)
{
  if (shape != "segments" && shape != "triangles" && shape != "quadrilaterals")
    throw UserError("no shape '" + shape + "': segments, triangles or quadrilaterals");
  const int dim = shape == "segments" ? 2 : 3;
  const auto kinds = dim == 2 ? kinds_2d() : kinds_3d();
  if (!kinds.contains(surface))
    throw UserError("no surface '" + surface + "' of " + shape);
  const Kind &kind = kinds.at(surface);
  const double along = dim == 2 ? n_nodes : std::sqrt(n_nodes * kind.ratio);
  const Size size{static_cast<int>(along), dim == 2 ? 1 : static_cast<int>(n_nodes / along)};
  const Size other{static_cast<int>(1.003 * size.n) + 2,
                   dim == 2 ? 1 : std::max(static_cast<int>(0.997 * size.m) - 1, 1)};
  const double edge = turn / size.n; // of a thin shell: the map's radius is 1
  const Map map = kind.thickness > 0 ? pressed(kind, dim - 1, dim == 2 ? 2.0 : 0.8, edge) : kind.map;
  const Map near =
      offset(map, dim, size, kind.thickness > 0 ? kind.thickness * edge : std::numeric_limits<double>::infinity());
  Scene scene{surface, shape, mesh(near, dim, other, shape == "triangles", kind.closed),
              mesh(map, dim, size, shape == "triangles", kind.closed)};
  turn_over(scene.impactor);
  if (kind.shuffled)
  {
    scene.impactor = test::shuffled(scene.impactor, 1);
    scene.target = test::shuffled(scene.target, 2);
  }
  scene.reach = largest_gap(near, map, dim, size);
  Target target(scene.target);
  target.move_to(scene.target.reference);
  scene.distance = search_distance(target, {}, scene.reach).w;
  return scene;
}

Positions moved(const Scene &scene, int step)
{
  const int dim = scene.target.dim;
  Positions positions{scene.impactor.reference, scene.target.reference};
  const double share = 0.025 * scene.distance * step;
  const std::array<double, 3> direction{0.48, -0.6, 0.64};
  for (std::size_t i = 0; i < positions.impactor.size(); ++i)
    positions.impactor[i] += share * direction[i % dim];
  for (std::size_t i = 0; i < positions.target.size(); i += dim)
  {
    const double phase = 3 * positions.target[i] + 2 * positions.target[i + 1];
    positions.target[i] += share * 0.6 * std::sin(phase);
    positions.target[i + dim - 1] += share * 0.8 * std::cos(phase);
  }
  return positions;
}
} // namespace amontons::benchmark
