#include "amontons/base/error.h"
#include "amontons/detection/detector.h"
#include "amontons/detection/self_contact_exclusions.h"
#include "amontons/surface/projection.h"
#include "self_contact_shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <iostream>
#include <set>

namespace amontons::test
{
namespace
{
using Outlines = std::vector<std::vector<PlanePoint>>;

struct Case
{
  std::string name;
  Outlines reference, now;
  double distance;      ///< w
  int overlap;          ///< winding number between a node that has come through and where it came from
  bool touches = false; ///< gaps of zero: their sign is round-off
  bool empty = false;   ///< nothing meets
};

// A ring pressed flat: two straight parts joined by half-circles, of the same length of the mean line. The upper one
// is bent down by `press`.
Outlines ring(double radius, double thickness, int n, double squeeze, double press = 0)
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

std::vector<Case> cases()
{
  const double t = 0.1;
  std::vector<Case> all;
  const auto add =
      [&](const std::string &name, const Strip &strip, const StripMap &reference, const StripMap &now, double distance)
  {
    all.push_back({name, {strip.outline(reference)}, {strip.outline(now)}, distance, 2});
    return &all.back();
  };
  const Strip strip{120, 3};
  const double leg = 2;
  const auto u = [&](double gap) { return folded_strip(2, leg, 0.065, t, 0.03 - gap); };
  const auto s = [&](double gap) { return folded_strip(3, leg, 0.065, t, 0.03 - gap); };
  add("U, open", strip, folded_strip(2, leg, 0.3, t), u(0.03), 0.15);
  add("U, through itself", strip, folded_strip(2, leg, 0.3, t), u(-0.01), 0.15);
  add("U, touching", strip, folded_strip(2, leg, 0.3, t), u(0), 0.15)->touches = true;
  add("U, touching from the start", strip, u(0), u(0), 0.15)->touches = true;
  add("U, w of many walls", strip, folded_strip(2, leg, 0.3, t), u(0.03), 0.8);
  add("S, folded from a flat strip", strip, flat(3 * leg, t), s(0.03), 0.15);
  add("S, through itself", strip, flat(3 * leg, t), s(-0.02), 0.15);
  const double length = 20;
  const Strip long_strip{500, 2};
  add("spiral", long_strip, spiral(1, 0.13, length, t), spiral(1, 0.13, length, t), 0.06);
  add("spiral rolled up from flat", long_strip, flat(length, t), spiral(0.8, 0.12, length, t), 0.15);
  add("spiral through itself", long_strip, flat(length, t), spiral(0.8, 0.08, length, t), 0.15);
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
  all.push_back({"ring", ring(1, t, 200, 1), ring(1, t, 200, 1), 0.3, 2, false, true});
  all.push_back({"ring, crushed", ring(1, t, 200, 1), ring(1, t, 200, 0.06), 0.15, 2});
  all.push_back({"ring, crushed through itself", ring(1, t, 200, 1), ring(1, t, 200, 0.06, 0.03), 0.15, 2});
  return all;
}

// Nodes whose edge-and-diagonal graph distance in the reference is at most `bound`: by Bellman and Ford, over all.
std::set<Index> within(const Surface &surface, Index start, double bound)
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

std::vector<double> flattened(const Outlines &outlines)
{
  std::vector<double> x;
  for (const auto &outline : outlines)
    for (const PlanePoint &p : outline)
      x.insert(x.end(), p.begin(), p.end());
  return x;
}

double longest_edge(const Surface &surface)
{
  double longest = 0;
  for (Index f = 0; f < surface.n_faces(); ++f)
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

Found detect(const Surface &surface, const std::vector<double> &x, double distance, DetectionMethod method,
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

void expect_same(const Pairing &a, const Pairing &b)
{
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    EXPECT_EQ(a[i].face, b[i].face) << "node " << i;
    EXPECT_EQ(a[i].reason, b[i].reason) << "node " << i;
    if (a[i].face >= 0 && b[i].face >= 0)
      EXPECT_NEAR(a[i].gap, b[i].gap, 1e-13) << "node " << i;
  }
}

bool is_corner(const Surface &surface, Index node)
{
  const auto faces = surface.faces_of_node(node);
  const auto normal = [&](Index f) {
    return face_normal(gather_face(surface.dim, surface.face(f), surface.reference), {0.3, 0.3});
  };
  return std::any_of(faces.begin(), faces.end(), [&](Index f) { return normal(f).dot(normal(faces[0])) < 0.7; });
}

// Between a node and the point it is paired with lies no body where there is a gap, and two layers of it where the
// node has come through; where it has been taken for the far side of its wall, there would be one. A corner that has
// come through sees its way out askew, past its own body.
Index expect_right_sides(const Case &c, const Surface &surface, const std::vector<double> &x, const Pairing &pairing)
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
    if (std::abs(pair.gap) > 1e-9 && !on_border(c.now, middle) && (pair.gap > 0 || !is_corner(surface, node)))
      EXPECT_EQ(winding(c.now, middle), pair.gap > 0 ? 0 : c.overlap)
          << "node " << node << " at " << x[first] << ' ' << x[first + 1] << ", gap " << pair.gap;
  }
  return n;
}

void expect_one_sided(const Surface &surface, const Pairing &pairing)
{
  for (Index node = 0; node < surface.n_nodes(); ++node)
    if (pairing[node].face >= 0)
      for (const Index other : surface.face(pairing[node].face))
        if (pairing[other].face >= 0)
          for (const Index third : surface.face(pairing[other].face))
            EXPECT_NE(third, node) << "nodes " << node << " and " << other << " are each on the other's face";
}

void expect_apart(const Surface &surface, const Pairing &pairing, double self_distance)
{
  for (Index node = 0; node < surface.n_nodes(); ++node)
  {
    if (pairing[node].face < 0)
      continue;
    const std::set<Index> near = within(surface, node, self_distance);
    for (const Index other : surface.face(pairing[node].face))
      EXPECT_FALSE(near.contains(other)) << "node " << node;
  }
}
} // namespace

TEST(SelfContact, RightSidesInThePlane)
{
  for (const Case &c : cases())
  {
    SCOPED_TRACE(c.name);
    const Surface surface = outlines_surface(c.reference);
    const std::vector<double> x = flattened(c.now);
    const Found exact = detect(surface, x, c.distance, DetectionMethod::exact);
    expect_same(exact.pairing, detect(surface, x, c.distance, DetectionMethod::brute).pairing);
    const Index n = expect_right_sides(c, surface, x, exact.pairing);
    expect_one_sided(surface, exact.pairing);
    std::cout << c.name << ": " << n << " pairs of " << surface.n_nodes() << " nodes, "
              << exact.report.self_contact->n_zones << " zones" << '\n';
  }
}
} // namespace amontons::test
