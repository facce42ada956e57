#pragma once
#include "surface/surfaces.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace amontons::test
{
using PlanePoint = std::array<double, 2>;

/// A strip of unit-square parameters: where the material point a along and b across it (both 0 to 1) lies.
using StripMap = std::function<PlanePoint(double a, double b)>;

/// Outline of a strip, counter-clockwise, so that normals point out: n faces along each side, m at each end.
struct Strip
{
  int n, m;

  [[nodiscard]] std::vector<PlanePoint> outline(const StripMap &map) const
  {
    std::vector<PlanePoint> points;
    for (int i = 0; i < n; ++i)
      points.push_back(map(static_cast<double>(i) / n, 0));
    for (int j = 0; j < m; ++j)
      points.push_back(map(1, static_cast<double>(j) / m));
    for (int i = n; i > 0; --i)
      points.push_back(map(static_cast<double>(i) / n, 1));
    for (int j = m; j > 0; --j)
      points.push_back(map(0, static_cast<double>(j) / m));
    return points;
  }
  /// 0 on the side b = 0, 1 on the side b = 1, -1 within the ends.
  [[nodiscard]] int side(Index node) const { return node <= n ? 0 : node >= n + m && node <= 2 * n + m ? 1 : -1; }
};

/// Winding number of closed outlines about a point: 0 outside, 1 in the body, 2 where it overlaps itself.
inline int winding(const std::vector<std::vector<PlanePoint>> &outlines, PlanePoint x)
{
  double turns = 0;
  for (const auto &outline : outlines)
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
      const PlanePoint a = outline[i], b = outline[(i + 1) % outline.size()];
      const double ax = a[0] - x[0], ay = a[1] - x[1], bx = b[0] - x[0], by = b[1] - x[1];
      turns += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
  return static_cast<int>(std::lround(turns / (2 * std::numbers::pi)));
}

/// Whether a point lies on one of the outlines.
inline bool on_border(const std::vector<std::vector<PlanePoint>> &outlines, PlanePoint x)
{
  for (const auto &outline : outlines)
    for (std::size_t i = 0; i < outline.size(); ++i)
    {
      const PlanePoint a = outline[i], b = outline[(i + 1) % outline.size()];
      const double to_a = std::hypot(a[0] - x[0], a[1] - x[1]), to_b = std::hypot(b[0] - x[0], b[1] - x[1]);
      if (to_a + to_b < (1 + 1e-12) * std::hypot(a[0] - b[0], a[1] - b[1]))
        return true;
    }
  return false;
}

/// A strip about a curve whose place and heading at the length s are given: x, y, angle of the tangent.
inline StripMap about_curve(const std::function<std::array<double, 3>(double s)> &curve, double length,
                            double thickness)
{
  return [=](double a, double b)
  {
    const auto [x, y, angle] = curve(a * length);
    const double offset = (b - 0.5) * thickness;
    return PlanePoint{x - offset * std::sin(angle), y + offset * std::cos(angle)};
  };
}

inline StripMap flat(double length, double thickness)
{
  return about_curve([](double s) { return std::array<double, 3>{s, 0, 0}; }, length, thickness);
}

/// Straight legs joined by half-circles of radius r to alternate sides: U with two legs, S with three. Each leg is
/// pressed towards the one before by `press`, over the first fifth of its length; the last is shorter than the others.
inline StripMap folded_strip(int n_legs, double leg, double r, double thickness, double press = 0)
{
  const double arc = std::numbers::pi * r, total = (n_legs - 0.3) * leg + (n_legs - 1) * arc;
  const auto curve = [=](double s)
  {
    for (int k = 0; k < n_legs; ++k)
    {
      const double direction = k % 2 == 0 ? 1 : -1, y = 2 * r * k - press * std::max(k - 1, 0);
      const double start = k % 2 == 0 ? 0 : leg;
      const double heading = k % 2 == 0 ? 0 : std::numbers::pi;
      if (s <= leg || k == n_legs - 1)
        return std::array<double, 3>{start + direction * s, y - (k > 0 ? press * std::min(s / (0.2 * leg), 1.0) : 0.0),
                                     heading};
      s -= leg;
      if (s <= arc)
      {
        const double phi = s / r;
        return std::array<double, 3>{start + direction * (leg + r * std::sin(phi)),
                                     y - (k > 0 ? press : 0) + r * (1 - std::cos(phi)), heading + direction * phi};
      }
      s -= arc;
    }
    return std::array<double, 3>{};
  };
  return about_curve(curve, total, thickness);
}

/// Archimedes' spiral whose turns are `pitch` apart, from radius r0 over the given length.
inline StripMap spiral(double r0, double pitch, double length, double thickness)
{
  const double growth = pitch / (2 * std::numbers::pi);
  const auto curve = [=](double s)
  {
    double theta = s / r0;
    for (int i = 0; i < 50; ++i) // the arc's length, nearly: r0 theta + growth theta^2 / 2
      theta -= (r0 * theta + growth * theta * theta / 2 - s) / (r0 + growth * theta);
    const double r = r0 + growth * theta;
    return std::array<double, 3>{r * std::cos(theta), r * std::sin(theta),
                                 theta + std::numbers::pi / 2 - std::atan2(growth, r)};
  };
  return about_curve(curve, length, thickness);
}

/// Closed outlines as one surface.
inline Surface outlines_surface(const std::vector<std::vector<PlanePoint>> &outlines)
{
  Surface surface;
  surface.dim = 2;
  Index first = 0;
  for (const auto &outline : outlines)
  {
    const auto n = static_cast<Index>(outline.size());
    for (Index i = 0; i < n; ++i)
    {
      surface.node_ids.push_back(first + i);
      surface.reference.insert(surface.reference.end(), outline[i].begin(), outline[i].end());
      surface.face_nodes.insert(surface.face_nodes.end(), {first + i, first + (i + 1) % n});
      surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
      surface.face_ids.push_back(first + i);
    }
    first += n;
  }
  surface.build_adjacency();
  return surface;
}

/// A closed surface of the plane drawn out along z from 0 to `depth` in n_z layers, without its end faces. Node i of
/// layer k is i + k * (nodes of the plane).
inline Surface drawn_out(const Surface &plane, int n_z, double depth, bool triangles)
{
  Surface surface;
  surface.dim = 3;
  const Index n = plane.n_nodes();
  for (int k = 0; k <= n_z; ++k)
    for (Index i = 0; i < n; ++i)
    {
      surface.node_ids.push_back(surface.n_nodes());
      surface.reference.insert(surface.reference.end(),
                               {plane.reference[2 * i], plane.reference[2 * i + 1], depth * k / n_z});
    }
  const auto add = [&surface](std::initializer_list<Index> nodes)
  {
    surface.face_nodes.insert(surface.face_nodes.end(), nodes);
    surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
    surface.face_ids.push_back(static_cast<GlobalIndex>(surface.face_ids.size()));
  };
  for (int k = 0; k < n_z; ++k)
    for (Index f = 0; f < plane.n_faces(); ++f)
    {
      const Index a = plane.face(f)[0] + k * n, b = plane.face(f)[1] + k * n;
      if (!triangles)
        add({a, b, b + n, a + n});
      else
      {
        add({a, b, b + n});
        add({a, b + n, a + n});
      }
    }
  surface.build_adjacency();
  return surface;
}

/// Coordinates of the drawn-out surface, the plane's given.
inline std::vector<double> drawn_out(const std::vector<double> &plane, int n_z, double depth)
{
  std::vector<double> x;
  for (int k = 0; k <= n_z; ++k)
    for (std::size_t i = 0; i < plane.size(); i += 2)
      x.insert(x.end(), {plane[i], plane[i + 1], depth * k / n_z});
  return x;
}
} // namespace amontons::test
