// What mortar has to pass on exactly: uniform pressures as consistent loads, linear motions as they are; and the search
// for faces, held against all pairs of faces.
#include "amontons/contact/mortar.h"

#include "amontons/surface/normals.h"
#include "amontons/surface/projection.h"
#include "surface/surfaces.h"

#include <gtest/gtest.h>

#include <numeric>

namespace amontons::test
{
namespace
{
using Eigen::Vector3d;

FacesInBox all_faces(const Surface &target)
{
  return [&](const Eigen::AlignedBox3d &, std::vector<Index> &faces)
  {
    faces.resize(static_cast<std::size_t>(target.n_faces()));
    std::iota(faces.begin(), faces.end(), 0);
  };
}

FacesInBox faces_in_box(const Surface &target)
{
  return [&](const Eigen::AlignedBox3d &box, std::vector<Index> &faces)
  {
    faces.clear();
    for (Index f = 0; f < target.n_faces(); ++f)
    {
      const FaceCoordinates face = gather_face(target.dim, target.face(f), target.reference);
      Eigen::AlignedBox3d own;
      for (int i = 0; i < face.n_nodes; ++i)
        own.extend(face.x[i]);
      if (own.intersects(box))
        faces.push_back(f);
    }
  };
}

MortarCoupling couple(const Surface &impactor, const Surface &target, bool axisymmetric = false, double w = 0.5)
{
  return couple_mortar({impactor, impactor.reference}, {target, target.reference}, axisymmetric, w,
                       faces_in_box(target));
}

Vector3d place(const Surface &surface, Index i)
{
  Vector3d x = Vector3d::Zero();
  std::copy_n(surface.reference.begin() + static_cast<std::ptrdiff_t>(i) * surface.dim, surface.dim, x.data());
  return x;
}

/// A tilted plane: flat maps of the unit square (or segment), distorted within the plane where asked.
struct Patch
{
  bool triangles = false;
  double distortion = 0;

  [[nodiscard]] static Vector3d tilt(double s, double t)
  {
    return Vector3d(1, 2, -1) + s * Vector3d(0.9, 0.1, 0.4) + t * Vector3d(-0.2, 1.1, 0.2);
  }
  /// @param up whether it looks along d/ds x d/dt @param low, high corners in (s, t)
  [[nodiscard]] Surface make(int n, int m, bool up, std::array<double, 2> low, std::array<double, 2> high) const
  {
    const auto map = [=, this](double s, double t)
    {
      const double a = s + distortion * std::sin(3 * s) * (1 - s) * t, b = t + distortion * t * (1 - t) * s;
      const Vector3d x = tilt(low[0] + (high[0] - low[0]) * a, low[1] + (high[1] - low[1]) * b);
      return Point{x[0], x[1], x[2]};
    };
    return up ? sheet(n, m, triangles, map) : sheet(m, n, triangles, [&](double s, double t) { return map(t, s); });
  }
};

/// Sums of weights are 1, and a linear field of the target is the impactor's own value, where both lie in one plane.
void expect_linear_fields_pass(const Surface &impactor, const Surface &target, const MortarCoupling &mortar,
                               double tolerance)
{
  const auto field = [](const Vector3d &x) { return 0.7 + Vector3d(1.3, -0.4, 0.8).dot(x); };
  for (Index j = 0; j < impactor.n_nodes(); ++j)
  {
    if (!mortar.sees_target(j))
      continue;
    double sum = 0, value = 0;
    for (std::size_t k = 0; k < mortar.targets_of(j).size(); ++k)
    {
      sum += mortar.weights_of(j)[k];
      value += mortar.weights_of(j)[k] * field(place(target, mortar.targets_of(j)[k]));
    }
    EXPECT_NEAR(sum, 1, tolerance);
    EXPECT_NEAR(value, field(place(impactor, j)), tolerance) << "node " << j;
  }
}

/// What a unit pressure on the impactor puts on each target node.
std::vector<double> target_forces(const Surface &target, const MortarCoupling &mortar)
{
  std::vector<double> out(static_cast<std::size_t>(target.n_nodes()), 0.0);
  for (std::size_t j = 0; j + 1 < mortar.offsets.size(); ++j)
    for (Index k = mortar.offsets[j]; k < mortar.offsets[j + 1]; ++k)
      out[mortar.targets[k]] += mortar.area[j] * mortar.weight[k];
  return out;
}

void expect_equal(std::span<const double> a, std::span<const double> b, double tolerance)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], tolerance) << "node " << i;
}

TEST(Mortar, WholeFacesInSpace)
{
  for (const bool triangles : {false, true})
    for (const double distortion : {0.0, 0.25})
    {
      const Patch patch{triangles, distortion};
      const Surface impactor = patch.make(4, 5, true, {0, 0}, {1, 1}), target = patch.make(7, 3, false, {0, 0}, {1, 1});
      const MortarCoupling mortar = couple(impactor, target);
      expect_equal(mortar.area, tributary_areas(impactor, false), 1e-9);
      expect_equal(target_forces(target, mortar), tributary_areas(target, false), 1e-9);
      expect_linear_fields_pass(impactor, target, mortar, 1e-8);
      EXPECT_LT((mortar.normal[0] + Vector3d(0.9, 0.1, 0.4).cross(Vector3d(-0.2, 1.1, 0.2)).normalized()).norm(),
                1e-13);
    }
}

// The target is smaller: faces covered in part carry the pressure of that part, and pass linear fields too.
TEST(Mortar, PartlyCoveredFacesInSpace)
{
  for (const bool triangles : {false, true})
  {
    const Patch patch{triangles, 0};
    const Surface impactor = patch.make(4, 5, true, {0, 0}, {1, 1});
    const Surface target = patch.make(3, 4, false, {0.13, 0.22}, {0.91, 0.84});
    const MortarCoupling mortar = couple(impactor, target);
    expect_equal(target_forces(target, mortar), tributary_areas(target, false), 1e-12);
    expect_linear_fields_pass(impactor, target, mortar, 1e-10);
    const auto whole = tributary_areas(target, false);
    EXPECT_NEAR(std::accumulate(mortar.area.begin(), mortar.area.end(), 0.0),
                std::accumulate(whole.begin(), whole.end(), 0.0), 1e-12);
  }
}

TEST(Mortar, PlaneAndRings)
{
  for (const bool axisymmetric : {false, true})
  {
    // The impactor looks down, so that it runs to the right; the target to the left.
    const Surface impactor = curve(5, [](double s) { return std::array{s * (1 + 0.2 * s), 0.3 * s * (1 + 0.2 * s)}; });
    const Surface whole = curve(7, [](double s) { return std::array{1.2 * (1 - s), 0.36 * (1 - s)}; });
    const MortarCoupling mortar = couple(impactor, whole, axisymmetric);
    expect_equal(mortar.area, tributary_areas(impactor, axisymmetric), 1e-13);
    expect_equal(target_forces(whole, mortar), tributary_areas(whole, axisymmetric), 1e-13);
    expect_linear_fields_pass(impactor, whole, mortar, 1e-12);

    const Surface part = curve(4, [](double s) { return std::array{0.2 + 0.57 * (1 - s), 0.06 + 0.171 * (1 - s)}; });
    const MortarCoupling partly = couple(impactor, part, axisymmetric);
    expect_equal(target_forces(part, partly), tributary_areas(part, axisymmetric), 1e-13);
    expect_linear_fields_pass(impactor, part, partly, 1e-11);
    EXPECT_FALSE(partly.sees_target(5));
    EXPECT_TRUE(partly.targets_of(5).empty());
  }
}

// The target ends a little past a node: the face beyond is covered by a sliver.
TEST(Mortar, SliversStayHarmless)
{
  for (double sliver = 0.1; sliver > 1e-16; sliver *= 0.1)
  {
    const Surface impactor = curve(4, [](double s) { return std::array{s, 0.0}; });
    const Surface target = curve(3, [=](double s) { return std::array{(0.5 + sliver) * (1 - s), 0.0}; });
    const MortarCoupling mortar = couple(impactor, target);
    expect_equal(target_forces(target, mortar), tributary_areas(target, false), 1e-12);
    for (const double weight : mortar.weight)
      EXPECT_LT(std::abs(weight), 3e3) << sliver;
    expect_linear_fields_pass(impactor, target, mortar, 1e-6);

    const Patch patch;
    const Surface sheet_impactor = patch.make(2, 2, true, {0, 0}, {1, 1});
    const Surface corner = patch.make(2, 3, false, {0, 0}, {0.5 + sliver, 0.5 + sliver});
    const MortarCoupling at_corner = couple(sheet_impactor, corner);
    expect_equal(target_forces(corner, at_corner), tributary_areas(corner, false), 1e-11);
    for (const double weight : at_corner.weight)
      EXPECT_LT(std::abs(weight), 3e4) << sliver;
    // Where a corner is left out, a face of four cannot hold every linear field any more.
    expect_linear_fields_pass(sheet_impactor, corner, at_corner, 1e-3);
  }
}

void expect_same(const MortarCoupling &a, const MortarCoupling &b)
{
  EXPECT_EQ(a.n_overlaps, b.n_overlaps);
  EXPECT_EQ(a.targets, b.targets);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.area, b.area);
}

TEST(Mortar, TheSearchMissesNoPairOfFaces)
{
  const Surface wavy = sheet(17, 12, true,
                             [](double s, double t) {
                               return Point{3 * s, 2 * t, 0.3 * std::sin(5 * s) * std::cos(4 * t)};
                             });
  const Surface other = sheet(9, 14, false,
                              [](double s, double t) {
                                return Point{3 * t, 2 * s, 0.02 + 0.3 * std::sin(5 * t) * std::cos(4 * s)};
                              });
  const Surface circle = curve(30, [](double s) { return std::array{std::cos(6 * s), std::sin(6 * s)}; });
  const Surface hole = curve(23, [](double s) { return std::array{1.05 * std::cos(6 * s), -1.05 * std::sin(6 * s)}; });
  for (const double w : {0.01, 0.1, 0.6})
    for (const auto &[impactor, target] : {std::pair{&wavy, &other}, {&circle, &hole}})
      expect_same(
          couple(*impactor, *target, false, w),
          couple_mortar({*impactor, impactor->reference}, {*target, target->reference}, false, w, all_faces(*target)));
}

// A ball in a socket: uniform pressure puts no net force on the target beyond the impactor's, normals are radial, and
// every gap is the difference of the radii to the order of the meshes.
TEST(Mortar, CurvedSurfaces)
{
  const auto arc = [](double radius, bool outwards)
  {
    return [=](double s)
    {
      const double angle = 0.3 + 2 * (outwards ? 1 - s : s);
      return std::array{radius * std::cos(angle), radius * std::sin(angle)};
    };
  };
  const Surface ball = curve(40, arc(1, false)), socket = curve(33, arc(1.02, true));
  const MortarCoupling mortar = couple(ball, socket, false, 0.1);
  for (Index j = 1; j + 1 < ball.n_nodes(); ++j)
  {
    ASSERT_TRUE(mortar.sees_target(j));
    EXPECT_LT((mortar.normal[j] + place(ball, j)).norm(), 1e-12);
    double gap = mortar.normal[j].dot(place(ball, j));
    for (std::size_t k = 0; k < mortar.targets_of(j).size(); ++k)
      gap -= mortar.weights_of(j)[k] * mortar.normal[j].dot(place(socket, mortar.targets_of(j)[k]));
    EXPECT_NEAR(gap, 0.02, 1e-3);
  }
}

TEST(Mortar, CurvedSurfacesInSpace)
{
  const auto ball = [](double radius)
  {
    return [=](double s, double t)
    {
      const double polar = 1.1 + 0.9 * t, azimuth = 0.2 + 0.8 * s;
      return Point{radius * std::sin(polar) * std::cos(azimuth), radius * std::sin(polar) * std::sin(azimuth),
                   -radius * std::cos(polar)};
    };
  };
  const auto turned = [](const auto &map) { return [=](double s, double t) { return map(t, s); }; };
  for (const bool triangles : {false, true})
  {
    const Surface inner = sheet(14, 15, triangles, ball(1)), outer = sheet(17, 11, triangles, turned(ball(1.02)));
    const MortarCoupling mortar = couple(inner, outer, false, 0.1);
    for (Index j = 0; j < inner.n_nodes(); ++j)
    {
      if (j % 15 == 0 || j % 15 == 14 || j < 15 || j >= 15 * 15) // on the rim
        continue;
      ASSERT_TRUE(mortar.sees_target(j));
      EXPECT_LT((mortar.normal[j] + place(inner, j)).norm(), 2e-3);
      double gap = mortar.normal[j].dot(place(inner, j)), sum = 0;
      for (std::size_t k = 0; k < mortar.targets_of(j).size(); ++k)
      {
        gap -= mortar.weights_of(j)[k] * mortar.normal[j].dot(place(outer, mortar.targets_of(j)[k]));
        sum += mortar.weights_of(j)[k];
      }
      EXPECT_NEAR(sum, 1, 1e-12);
      EXPECT_NEAR(gap, 0.02, 2e-3);
    }
  }
}

TEST(Mortar, OfTwoLayersTheNearerCounts)
{
  const Surface impactor = curve(4, [](double s) { return std::array{s, 0.0}; });
  Surface target = curve(3, [](double s) { return std::array{1 - s, -0.01}; });
  const Surface below = curve(3, [](double s) { return std::array{0.6 - 0.5 * s, -0.1}; });
  const MortarCoupling alone = couple(impactor, target);
  for (Index i = 0; i < below.n_nodes(); ++i)
    target.node_ids.push_back(target.n_nodes());
  target.reference.insert(target.reference.end(), below.reference.begin(), below.reference.end());
  for (Index f = 0; f < below.n_faces(); ++f)
  {
    for (const Index node : below.face(f))
      target.face_nodes.push_back(4 + node);
    target.face_offsets.push_back(static_cast<Index>(target.face_nodes.size()));
    target.face_ids.push_back(10 + f);
  }
  expect_same(couple(impactor, target), alone);
}
} // namespace
} // namespace amontons::test
