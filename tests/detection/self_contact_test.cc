#include "self_contact_checks.h"

namespace amontons::test::self_contact
{
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
    EXPECT_EQ(n == 0, c.empty);
    expect_one_sided(surface, exact.pairing);
    expect_covered(c, surface, x, exact.pairing);
    EXPECT_EQ(exact.report.self_contact->n_zones == 0, c.empty);
    if (!c.empty && surface.n_nodes() < 500)
      expect_apart(surface, exact.pairing);
    std::cout << c.name << ": " << n << " pairs of " << surface.n_nodes() << " nodes\n";
  }
}

TEST(SelfContact, RightSidesInSpace)
{
  constexpr int layers = 2;
  constexpr double depth = 0.1;
  const std::set<std::string> names{"U, through itself", "U, touching from the start", "S, folded from a flat strip",
                                    "wall, bent and stretched", "ring, crushed"};
  for (const Case &c : cases())
    for (const bool triangles : {false, true})
    {
      if (!names.contains(c.name))
        continue;
      SCOPED_TRACE(c.name + (triangles ? ", triangles" : ", quadrilaterals"));
      const Surface surface = drawn_out(outlines_surface(c.reference), layers, depth, triangles);
      const std::vector<double> x = drawn_out(flattened(c.now), layers, depth);
      const Found exact = detect(surface, x, c.distance, DetectionMethod::exact);
      expect_same(exact.pairing, detect(surface, x, c.distance, DetectionMethod::brute).pairing);
      const Index n = expect_right_sides(c, surface, x, exact.pairing);
      EXPECT_EQ(n == 0, c.empty);
      expect_one_sided(surface, exact.pairing);
      // Of each cross section the same nodes are paired as in the plane, but for those within the self-distance.
      const Found plane = detect(outlines_surface(c.reference), flattened(c.now), c.distance, DetectionMethod::exact);
      EXPECT_NEAR(n, (layers + 1) * plane.report.n_pairs, 0.25 * n);
      std::cout << c.name << ": " << n << " pairs of " << surface.n_nodes() << " nodes\n";
    }
}

TEST(SelfContact, OneSideOfAFoldIsImpactorAllAlong)
{
  const Strip strip{500, 2};
  const Surface surface = outlines_surface({strip.outline(flat(20, 0.1))});
  const std::vector<double> x = flattened({strip.outline(spiral(0.8, 0.12, 20, 0.1))});
  std::array<int, 2> n{0, 0};
  const Found found = detect(surface, x, 0.15, DetectionMethod::exact);
  for (Index node = 0; node < surface.n_nodes(); ++node)
    if (found.pairing[node].face >= 0 && strip.side(node) >= 0)
      ++n[strip.side(node)];
  EXPECT_EQ(std::min(n[0], n[1]), 0);
  EXPECT_GT(std::max(n[0], n[1]), 250);
}

// Two strips above each other, in one group: bodies of their own.
struct TwoStrips
{
  TwoStrips(int n_lower, int n_upper, double gap)
  {
    const auto shifted = [](StripMap map, double y)
    {
      return [=](double a, double b)
      {
        const PlanePoint x = map(a, b);
        return PlanePoint{x[0], x[1] + y};
      };
    };
    outlines = {Strip{n_lower, 2}.outline(flat(2, 0.1)), Strip{n_upper, 2}.outline(shifted(flat(2, 0.1), 0.1 + gap))};
    surface = outlines_surface(outlines);
    lower_size = static_cast<Index>(outlines[0].size());
    for (Index f = 0; f < surface.n_faces(); ++f)
      surface.face_bodies.push_back(f < lower_size ? 0 : 1);
  }
  [[nodiscard]] std::array<Index, 2> impactors(const Pairing &pairing) const
  {
    std::array<Index, 2> n{0, 0};
    for (Index node = 0; node < surface.n_nodes(); ++node)
      if (pairing[node].face >= 0)
        ++n[node < lower_size ? 0 : 1];
    return n;
  }
  Outlines outlines;
  Surface surface;
  Index lower_size = 0;
};

TEST(SelfContact, TheFinerSideIsImpactorThenTheSmallerId)
{
  for (const double gap : {0.01, -0.01})
  {
    const auto impactors = [gap](int n_lower, int n_upper)
    {
      const TwoStrips strips(n_lower, n_upper, gap);
      return strips.impactors(detect(strips.surface, strips.surface.reference, 0.05, DetectionMethod::exact).pairing);
    };
    // Ends may see a face besides.
    EXPECT_EQ(impactors(40, 40), (std::array<Index, 2>{41, 0}));
    EXPECT_EQ(impactors(80, 40), (std::array<Index, 2>{81, 0}));
    EXPECT_EQ(impactors(40, 80), (std::array<Index, 2>{0, 81}));
  }
}

TEST(SelfContact, OverlapInTheReferenceIsSeenBetweenBodiesOnly)
{
  TwoStrips strips(40, 40, -0.01);
  const auto n_pairs = [&]
  { return detect(strips.surface, strips.surface.reference, 0.05, DetectionMethod::exact).report.n_pairs; };
  EXPECT_EQ(n_pairs(), 41);
  strips.surface.face_bodies.clear();
  EXPECT_EQ(n_pairs(), 0);
}

TEST(SelfContact, RolesAreKept)
{
  // The upper strip is finer at first; the lower one would be, were it asked again after its nodes have moved together.
  const TwoStrips strips(40, 60, 0.01);
  DetectionOptions options;
  options.distance = 0.05;
  const auto detector = make_self_detector(options, strips.surface);
  std::vector<double> x = strips.surface.reference;
  const auto move_upper = [&](double dx, double dy)
  {
    for (Index node = strips.lower_size; node < strips.surface.n_nodes(); ++node)
    {
      x[2 * node] = strips.surface.reference[2 * node] + dx;
      x[2 * node + 1] = strips.surface.reference[2 * node + 1] + dy;
    }
  };
  for (const double dx : {0.0, 0.3, 0.9, 1.5, 0.2, -0.4, -1.7, 0.0})
    for (const double dy : {0.02, -0.015, 0.5, 0.0})
    {
      move_upper(dx, dy);
      const auto [lower, upper] = strips.impactors(detector->detect(x, x, 0));
      EXPECT_EQ(lower, 0) << dx << ' ' << dy;
      EXPECT_EQ(upper == 0, dy == 0.5) << dx << ' ' << dy;
    }
}

TEST(SelfContact, DetectionAfterMotionsIsAsFromScratch)
{
  const Strip strip{120, 3};
  const Surface surface = outlines_surface({strip.outline(folded_strip(2, 2, 0.3, 0.1))});
  DetectionOptions options;
  options.distance = 0.15;
  const auto exact = make_self_detector(options, surface);
  options.method = DetectionMethod::brute;
  const auto brute = make_self_detector(options, surface);
  for (int step = 0; step <= 100; ++step)
  {
    const double press = 0.05 * step / 100, radius = 0.3 - 0.235 * step / 100;
    const std::vector<double> x = flattened({strip.outline(folded_strip(2, 2, radius, 0.1, press))});
    expect_same(exact->detect(x, x, 0), brute->detect(x, x, 0));
  }
  EXPECT_GT(exact->report().n_penetrations, 10);
}

TEST(SelfContact, SelfDistance)
{
  const Strip strip{120, 3};
  const Outlines now{strip.outline(folded_strip(2, 2, 0.065, 0.1))};
  const Surface surface = outlines_surface(now);
  for (const double self_distance : {0.0, 0.2, 1.0, 2.0})
  {
    const Found found = detect(surface, surface.reference, 0.15, DetectionMethod::exact, self_distance);
    EXPECT_GT(found.report.n_pairs, 0);
    expect_apart(surface, found.pairing, self_distance);
    EXPECT_EQ(found.report.self_contact->least_distance, self_distance);
    const Exclusions exclusions(surface, self_distance);
    for (Index node = 0; node < surface.n_nodes(); node += 7)
    {
      const std::set<Index> near = within(surface, node, (1 + 1e-9) * self_distance);
      for (Index f = 0; f < surface.n_faces(); ++f)
        EXPECT_EQ(exclusions.is_near(node, f), near.contains(surface.face(f)[0]) || near.contains(surface.face(f)[1]));
    }
  }
  EXPECT_EQ(detect(surface, surface.reference, 0.15, DetectionMethod::exact, 20).report.n_pairs, 0);
  EXPECT_THROW(make_self_detector({}, surface, -1), UserError);
  EXPECT_THROW(make_self_detector({}, surface, INFINITY), UserError);
}

TEST(SelfContact, NearestNodeSeesTheRightSidesToo)
{
  for (const Case &c : cases())
  {
    if (c.distance > 0.5)
      continue; // it does not look at what lies behind the nearest node's faces
    SCOPED_TRACE(c.name);
    const Surface surface = outlines_surface(c.reference);
    const std::vector<double> x = flattened(c.now);
    const Found found = detect(surface, x, c.distance, DetectionMethod::nearest_node);
    const Index n = expect_right_sides(c, surface, x, found.pairing);
    EXPECT_EQ(n == 0, c.empty);
    expect_one_sided(surface, found.pairing);
  }
}
} // namespace amontons::test::self_contact
