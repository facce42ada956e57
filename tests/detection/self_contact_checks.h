#pragma once
#include "amontons/base/error.h"
#include "amontons/detection/detector.h"
#include "amontons/detection/self_contact_exclusions.h"
#include "amontons/surface/projection.h"
#include "self_contact_shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <iostream>
#include <set>

/// Surfaces that meet themselves, and what must hold of their pairs whoever found them.
namespace amontons::test::self_contact
{
using Outlines = std::vector<std::vector<PlanePoint>>;

struct Case
{
  std::string name;
  Outlines reference, now;
  double distance;      ///< w
  bool empty = false;   ///< nothing meets
  bool through = false; ///< the body goes through itself
};

// A ring pressed flat: two straight parts joined by half-circles, of the same length of the mean line. The upper one
// is bent down by `press`.
inline Outlines ring(double radius, double thickness, int n, double squeeze, double press = 0)
{
  const double half = squeeze * radius, straight = std::numbers::pi * (radius - half);
  const double length = 2 * straight + 2 * std::numbers::pi * half;
  Outlines outlines(2);
  for (int i = 0; i < n; ++i)
    for (int which = 0; which < 2; ++which)
    {
      // The inner outline runs the other way round.
      double s = length * (which == 0 ? i : n - i) / n;
      s = std::fmod(s, length);
      const double offset = half + (which == 0 ? 0.5 : -0.5) * thickness;
      const double turn = std::numbers::pi * half;
      PlanePoint x{};
      if (s < straight)
        x = {-straight / 2 + s, -offset};
      else if (s < straight + turn)
        x = {straight / 2 + offset * std::sin((s - straight) / half), -offset * std::cos((s - straight) / half)};
      else if (s < 2 * straight + turn)
      {
        const double along = (s - straight - turn) / straight;
        x = {straight * (0.5 - along), offset - press * std::min(1.0, 5 * std::min(along, 1 - along))};
      }
      else
        x = {-straight / 2 - offset * std::sin((s - 2 * straight - turn) / half),
             offset * std::cos((s - 2 * straight - turn) / half)};
      outlines[which].push_back(x);
    }
  return outlines;
}

inline std::vector<Case> cases()
{
  const double t = 0.1;
  std::vector<Case> all;
  const auto add =
      [&](const std::string &name, const Strip &strip, const StripMap &reference, const StripMap &now, double distance)
  {
    all.push_back({name, {strip.outline(reference)}, {strip.outline(now)}, distance});
    return &all.back();
  };
  const Strip strip{120, 3};
  const double leg = 2;
  const auto u = [&](double gap) { return folded_strip(2, leg, 0.065, t, 0.03 - gap); };
  const auto s = [&](double gap) { return folded_strip(3, leg, 0.065, t, 0.03 - gap); };
  add("U, open", strip, folded_strip(2, leg, 0.3, t), u(0.03), 0.15);
  add("U, through itself", strip, folded_strip(2, leg, 0.3, t), u(-0.01), 0.15)->through = true;
  add("U, touching", strip, folded_strip(2, leg, 0.3, t), u(0), 0.15);
  add("U, touching from the start", strip, u(0), u(0), 0.15);
  add("U, w of many walls", strip, folded_strip(2, leg, 0.3, t), u(0.03), 0.8);
  add("S, folded from a flat strip", strip, flat(3 * leg, t), s(0.03), 0.15);
  add("S, through itself", strip, flat(3 * leg, t), s(-0.02), 0.15)->through = true;
  const double length = 20;
  const Strip long_strip{500, 2};
  add("spiral", long_strip, spiral(1, 0.13, length, t), spiral(1, 0.13, length, t), 0.06);
  add("spiral rolled up from flat", long_strip, flat(length, t), spiral(0.8, 0.12, length, t), 0.15);
  add("spiral through itself", long_strip, flat(length, t), spiral(0.8, 0.08, length, t), 0.15)->through = true;
  add("wall", strip, flat(6, t), flat(6, t), 0.5)->empty = true;
  add("wall, far thinner than w", strip, flat(6, 0.01), flat(6, 0.01), 0.5)->empty = true;
  add("wall, bent and stretched", strip, flat(6, t),
      about_curve(
          [](double x)
          {
            const double phi = x / 2.5;
            return std::array<double, 3>{3 * std::sin(phi), 3 * (1 - std::cos(phi)), phi};
          },
          6, 0.08),
      0.5)
      ->empty = true;
  all.push_back({"ring", ring(1, t, 200, 1), ring(1, t, 200, 1), 0.3, true});
  all.push_back({"ring, crushed", ring(1, t, 200, 1), ring(1, t, 200, 0.06), 0.15});
  all.push_back({"ring, crushed through itself", ring(1, t, 200, 1), ring(1, t, 200, 0.06, 0.03), 0.15, false, true});
  return all;
}

// Nodes whose edge-and-diagonal graph distance in the reference is at most `bound`: by Bellman and Ford, over all.
inline std::set<Index> within(const Surface &surface, Index start, double bound)
{
  std::vector<double> distance(surface.n_nodes(), INFINITY);
  distance[start] = 0;
  const auto x = [&](Index node, int c) { return surface.reference[node * surface.dim + c]; };
  for (bool better = true; better;)
  {
    better = false;
    for (Index f = 0; f < surface.n_faces(); ++f)
      for (const Index a : surface.face(f))
        for (const Index b : surface.face(f))
        {
          double squared = 0;
          for (int c = 0; c < surface.dim; ++c)
            squared += (x(a, c) - x(b, c)) * (x(a, c) - x(b, c));
          if (const double to = distance[a] + std::sqrt(squared); to < distance[b] && to <= bound)
          {
            distance[b] = to;
            better = true;
          }
        }
  }
  std::set<Index> nodes;
  for (Index node = 0; node < surface.n_nodes(); ++node)
    if (distance[node] <= bound)
      nodes.insert(node);
  return nodes;
}

inline std::vector<double> flattened(const Outlines &outlines)
{
  std::vector<double> x;
  for (const auto &outline : outlines)
    for (const PlanePoint &p : outline)
      x.insert(x.end(), p.begin(), p.end());
  return x;
}

inline double longest_edge(const Surface &surface, Index node)
{
  double longest = 0;
  for (const Index f : surface.faces_of_node(node))
  {
    const FaceCoordinates face = gather_face(surface.dim, surface.face(f), surface.reference);
    for (int k = 0; k < face.n_nodes; ++k)
      longest = std::max(longest, (face.x[(k + 1) % face.n_nodes] - face.x[k]).norm());
  }
  return longest;
}

struct Found
{
  Pairing pairing;
  DetectionReport report;
};

inline Found detect(const Surface &surface, const std::vector<double> &x, double distance, DetectionMethod method,
                    std::optional<double> self_distance = {})
{
  DetectionOptions options;
  options.method = method;
  options.distance = distance;
  const auto detector = make_self_detector(options, surface, self_distance);
  Found found;
  found.pairing = detector->detect(x, x, 0);
  found.report = detector->report();
  return found;
}

inline void expect_same(const Pairing &a, const Pairing &b)
{
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    EXPECT_EQ(a[i].face, b[i].face) << "node " << i;
    EXPECT_EQ(a[i].reason, b[i].reason) << "node " << i;
    if (a[i].face >= 0 && b[i].face >= 0)
      EXPECT_NEAR(a[i].gap, b[i].gap, 1e-13) << "node " << i;
  }
}

inline bool is_bent(const Surface &surface, const std::vector<double> &x, Index node, double cosine = 0.99)
{
  const auto faces = surface.faces_of_node(node);
  const auto normal = [&](Index f) { return face_normal(gather_face(surface.dim, surface.face(f), x), {0.3, 0.3}); };
  return std::any_of(faces.begin(), faces.end(), [&](Index f) { return normal(f).dot(normal(faces[0])) < cosine; });
}

// Between a node and the point it is paired with lies no body where there is a gap, and two layers of it where the
// node has come through; where it has been taken for the far side of its wall, there would be one. At a
// corner that has come through, or where one is met, the way out is askew, past the body.
inline Index expect_right_sides(const Case &c, const Surface &surface, const std::vector<double> &x,
                                const Pairing &pairing)
{
  Index n = 0;
  for (Index node = 0; node < surface.n_nodes(); ++node)
  {
    const Pair &pair = pairing[node];
    if (pair.face < 0)
      continue;
    ++n;
    const Eigen::Vector3d point = face_point(gather_face(surface.dim, surface.face(pair.face), x), pair.xi);
    const std::size_t first = static_cast<std::size_t>(node) * surface.dim;
    const PlanePoint middle{0.5 * (point.x() + x[first]), 0.5 * (point.y() + x[first + 1])};
    if (std::abs(pair.gap) > 1e-9 && !on_border(c.now, middle) &&
        (pair.gap > 0 || (pair.kind == PairKind::face && !is_bent(surface, surface.reference, node, 0.7))))
      EXPECT_EQ(winding(c.now, middle), pair.gap > 0 ? 0 : 2)
          << "node " << node << " at " << x[first] << ' ' << x[first + 1] << ", gap " << pair.gap;
  }
  return n;
}

inline void expect_one_sided(const Surface &surface, const Pairing &pairing)
{
  for (Index node = 0; node < surface.n_nodes(); ++node)
    if (pairing[node].face >= 0)
      for (const Index other : surface.face(pairing[node].face))
        if (pairing[other].face >= 0)
          for (const Index third : surface.face(pairing[other].face))
            EXPECT_NE(third, node) << "nodes " << node << " and " << other << " are each on the other's face";
}

// The first face met on the way out of the body along a node's normal, in the plane, and how far it is; no neighbour.
inline std::pair<Index, double> straight_before(const Surface &surface, const std::vector<double> &x, Index node)
{
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const Index f : surface.faces_of_node(node))
    normal += face_normal(gather_face(2, surface.face(f), x), {0.5, 0.5});
  normal.normalize();
  const std::set<Index> near = within(surface, node, 4 * longest_edge(surface, node));
  std::pair<Index, double> first{-1, INFINITY};
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    if (near.contains(surface.face(f)[0]))
      continue;
    const FaceCoordinates face = gather_face(2, surface.face(f), x);
    const Eigen::Vector3d offset = face.x[0] - Eigen::Vector3d(x[2 * node], x[2 * node + 1], 0);
    const Eigen::Vector3d along = face.x[1] - face.x[0];
    const double determinant = normal.x() * along.y() - normal.y() * along.x();
    const double distance = (offset.x() * along.y() - offset.y() * along.x()) / determinant;
    const double share = (offset.x() * normal.y() - offset.y() * normal.x()) / determinant;
    if (share >= 0 && share <= 1 && distance > -1e-9 && distance < first.second)
      first = {f, distance};
  }
  return first;
}

// Every node with another part of the body straight before it and nearer than half of w is impactor, or the face
// before it holds one.
inline void expect_covered(const Case &c, const Surface &surface, const std::vector<double> &x, const Pairing &pairing)
{
  if (c.through)
    return;
  for (Index node = 0; node < surface.n_nodes(); ++node)
  {
    if (is_bent(surface, x, node))
      continue;
    const auto [face, distance] = straight_before(surface, x, node);
    if (face < 0 || distance > 0.5 * c.distance)
      continue;
    const auto nodes = surface.face(face);
    EXPECT_TRUE(pairing[node].face >= 0 || pairing[nodes[0]].face >= 0 || pairing[nodes[1]].face >= 0)
        << "node " << node << " at " << x[2 * node] << ' ' << x[2 * node + 1];
  }
}

// Absent: twice the longest edge of the node's faces.
inline void expect_apart(const Surface &surface, const Pairing &pairing, std::optional<double> self_distance = {})
{
  for (Index node = 0; node < surface.n_nodes(); ++node)
  {
    if (pairing[node].face < 0)
      continue;
    const std::set<Index> near = within(surface, node, self_distance.value_or(2 * longest_edge(surface, node)));
    for (const Index other : surface.face(pairing[node].face))
      EXPECT_FALSE(near.contains(other)) << "node " << node;
  }
}
} // namespace amontons::test::self_contact
