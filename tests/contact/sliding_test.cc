#include "amontons/base/error.h"
#include "amontons/contact/frame.h"
#include "amontons/contact/kinematics.h"
#include "measures.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A rigid motion of space (of the plane z = 0 in 2D).
struct Motion
{
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vector3d translation = Vector3d::Zero();

  static Motion any(Random &random, int dim)
  {
    Motion out{random_rotation(random, dim), random_vector(random, 3)};
    if (dim == 2)
      out.translation.z() = 0;
    return out;
  }
  [[nodiscard]] VectorXd operator()(int dim, const VectorXd &points) const
  {
    VectorXd out(points.size());
    for (int i = 0; i < points.size() / dim; ++i)
    {
      Vector3d x = Vector3d::Zero();
      x.head(dim) = points.segment(dim * i, dim);
      out.segment(dim * i, dim) = (rotation * x + translation).head(dim);
    }
    return out;
  }
};

/// A face of each kind near the origin, outward normal about +z (in the plane -y).
VectorXd some_face(Random &random, int dim, int n_nodes)
{
  VectorXd face(dim * n_nodes);
  if (n_nodes == 2)
    face << 0, 0, 1, 0;
  else if (n_nodes == 3)
    face << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  else
    face << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  return face + 0.1 * random_vector(random, dim * n_nodes);
}

VectorXd some_point(Random &random, int dim)
{
  VectorXd x = random_vector(random, dim, 0.1, 0.5);
  x[dim - 1] = uniform(random, -.1, .1);
  return x;
}

Vector3d slip_vector(const ContactLinearisation &lin)
{
  Vector3d sum = Vector3d::Zero();
  for (int c = 0; c < lin.n_tangents(); ++c)
    sum += lin.slip[c] * lin.tangent[c];
  return sum;
}

struct FaceKind
{
  int dim, n_nodes;
};
constexpr std::array face_kinds{FaceKind{2, 2}, FaceKind{3, 3}, FaceKind{3, 4}};

TEST(Objectivity, RigidMotionsOfNowAndThenChangeNothing)
{
  for (const auto &[dim, n_nodes] : face_kinds)
    for (unsigned seed = 0; seed < 20; ++seed)
    {
      Random random(seed);
      const VectorXd face = some_face(random, dim, n_nodes), x = some_point(random, dim);
      const VectorXd start = some_face(random, dim, n_nodes), origin = some_point(random, dim);
      const Motion now = Motion::any(random, dim), then = Motion::any(random, dim);
      const auto lin = linearise_finite(dim, span(x), span(face), span(origin), span(start), {.5, .5});
      const auto moved = linearise_finite(dim, span(now(dim, x)), span(now(dim, face)), span(then(dim, origin)),
                                          span(then(dim, start)), {.5, .5});
      EXPECT_NEAR(moved.gap, lin.gap, 1e-13);
      for (int c = 0; c < lin.n_tangents(); ++c)
        EXPECT_NEAR(moved.slip[c], lin.slip[c], 1e-12);
      EXPECT_LT((moved.normal - now.rotation * lin.normal).norm(), 1e-13);
      Motion turned{now.rotation, Vector3d::Zero()};
      EXPECT_LT((moved.slip_direction[0] - turned(dim, lin.slip_direction[0])).norm(), 1e-12);
    }
}

TEST(Objectivity, StickingNodeCarriedByItsFaceDoesNotSlip)
{
  for (const auto &[dim, n_nodes] : face_kinds)
  {
    Random random(7);
    const VectorXd face = some_face(random, dim, n_nodes), x = some_point(random, dim);
    const Motion carried = Motion::any(random, dim);
    const auto lin = linearise_finite(dim, span(carried(dim, x)), span(carried(dim, face)), span(x), span(face), {});
    EXPECT_LT(slip_vector(lin).norm(), 1e-13);
  }
}

TEST(Objectivity, ShapesMoveWithTheirPoint)
{
  Random random(5);
  const Shape sphere{ShapeType::sphere, {}, {0, 1, 0}, 1};
  const VectorXd x = random_vector(random, 3), point = random_vector(random, 3), origin = random_vector(random, 3);
  const VectorXd shift = random_vector(random, 3), other = random_vector(random, 3);
  const auto lin = linearise_shape(3, false, sphere, span(x), span(point), span(origin), span(VectorXd(point)));
  const auto moved = linearise_shape(3, false, sphere, span(x + shift), span(point + shift), span(origin + other),
                                     span(point + other));
  EXPECT_NEAR(moved.gap, lin.gap, 1e-14);
  EXPECT_NEAR(moved.slip[0], lin.slip[0], 1e-14);
  EXPECT_NEAR(moved.slip[1], lin.slip[1], 1e-14);
}

/// Slip summed over steps of a node along a chain of coplanar faces that all move rigidly meanwhile; each step is
/// measured on the face under the node's new place. `path` and `faces` lie in the target's own frame.
Vector3d total_slip(int dim, const std::vector<VectorXd> &faces, const std::vector<VectorXd> &path,
                    const std::vector<int> &face_under, unsigned seed)
{
  Random random(seed);
  Vector3d total = Vector3d::Zero();
  Motion before;
  for (std::size_t step = 1; step < path.size(); ++step)
  {
    const Motion after = Motion::any(random, dim);
    const VectorXd &face = faces[face_under[step]];
    const auto lin = linearise_finite(dim, span(after(dim, path[step])), span(after(dim, face)),
                                      span(before(dim, path[step - 1])), span(before(dim, face)), {.5, .5});
    total += after.rotation.transpose() * slip_vector(lin);
    before = after;
  }
  return total;
}

VectorXd vector(std::initializer_list<double> values)
{
  return Eigen::Map<const VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

TEST(SlipAcrossFaces, SegmentsOfUnequalLength)
{
  const std::vector<double> nodes{0, 0.3, 1.5, 1.6, 3};
  std::vector<VectorXd> faces;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i)
    faces.push_back(vector({nodes[i], 0, nodes[i + 1], 0}));
  const std::vector<VectorXd> path{vector({.1, 0}),     vector({.7, .01}), vector({1.55, 0}),
                                   vector({2.9, -.02}), vector({.2, 0}),   vector({2.5, 0})};
  const Vector3d total = total_slip(2, faces, path, {0, 1, 2, 3, 0, 3}, 1);
  EXPECT_LT((total - Vector3d(2.4, 0, 0)).norm(), 1e-13);
}

TEST(SlipAcrossFaces, TrianglesAndDistortedQuadrilaterals)
{
  // Nodes of a flat, irregular grid: 0..3 along y = 0, 4..7 about y = 1.
  const std::vector<Vector3d> grid{{0, 0, 0},    {.5, -.1, 0}, {1.6, .2, 0},  {3, 0, 0},
                                   {.1, 1.1, 0}, {.9, .8, 0},  {1.4, 1.2, 0}, {2.8, .9, 0}};
  const auto face_of_nodes = [&](std::initializer_list<int> nodes)
  {
    VectorXd out(3 * nodes.size());
    int i = 0;
    for (const int node : nodes)
      out.segment<3>(3 * i++) = grid[node];
    return out;
  };
  const std::vector<VectorXd> path{vector({.3, .4, 0}),     vector({.9, .45, 0.01}), vector({1.3, .6, 0}),
                                   vector({2.4, .5, -.01}), vector({.35, .3, 0}),    vector({2.2, .6, 0})};
  const Vector3d expected(1.9, .2, 0);
  const std::vector<VectorXd> quads{face_of_nodes({0, 1, 5, 4}), face_of_nodes({1, 2, 6, 5}),
                                    face_of_nodes({2, 3, 7, 6})};
  EXPECT_LT((total_slip(3, quads, path, {0, 1, 1, 2, 0, 2}, 2) - expected).norm(), 1e-12);
  const std::vector<VectorXd> triangles{face_of_nodes({0, 1, 5}), face_of_nodes({1, 2, 6}), face_of_nodes({2, 3, 7})};
  EXPECT_LT((total_slip(3, triangles, path, {0, 1, 1, 2, 0, 2}, 3) - expected).norm(), 1e-12);
}

TEST(Closing, FractionOfTheIncrement)
{
  EXPECT_DOUBLE_EQ(closing_fraction(0.1, -0.3), 0.25);
  EXPECT_EQ(closing_fraction(0, -1), 0);
  EXPECT_EQ(closing_fraction(-0.1, -1), 0);
  EXPECT_EQ(closing_fraction(0.1, 0.05), 1);
}

TEST(Closing, SlipCountsFromTheInstantOfClosing)
{
  // From 0.1 above to 0.3 below while going 0.8 along the face: touches after a quarter of it. The target moves too.
  for (const auto &[dim, n_nodes] : face_kinds)
  {
    Random random(11);
    VectorXd face(dim * n_nodes), start(dim), end(dim);
    if (dim == 2)
    {
      face << 2, 0, 0, 0; // outward normal +y
      start << 0.2, 0.1;
      end << 1.0, -0.3;
    }
    else
    {
      const VectorXd square = vector({0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0});
      face = n_nodes == 4 ? square : VectorXd(square.head(9));
      start << 0.5, 0.2, 0.1;
      end << 1.3, 0.2, -0.3;
    }
    const Motion then = Motion::any(random, dim), now = Motion::any(random, dim);
    const VectorXd face_then = then(dim, face), face_now = now(dim, face), x_now = now(dim, end);
    const Vector3d origin =
        closing_origin_finite(dim, span(x_now), span(face_now), span(then(dim, start)), span(face_then), {.5, .5});
    VectorXd place = start + 0.25 * (end - start);
    EXPECT_LT((origin.head(dim) - then(dim, place)).norm(), 1e-13);
    const auto lin = linearise_finite(dim, span(x_now), span(face_now), span(origin.head(dim)), span(face_then), {});
    EXPECT_LT((now.rotation.transpose() * slip_vector(lin) - Vector3d(0.6, 0, 0)).norm(), 1e-13);
  }
}

TEST(Closing, OnAShape)
{
  const Shape floor{ShapeType::plane, {}, {0, 1, 0}};
  // The floor has gone down by 1 and right by 2 meanwhile.
  const VectorXd start = vector({0, 0.1}), now = vector({2.8, -1.3}), floor_start = vector({0, 0}),
                 floor_now = vector({2, -1});
  const Vector3d origin =
      closing_origin_shape(2, false, floor, span(now), span(floor_now), span(start), span(floor_start));
  EXPECT_LT((origin - Vector3d(0.2, 0, 0)).norm(), 1e-14);
  const auto lin =
      linearise_shape(2, false, floor, span(now), span(floor_now), span(origin.head(2)), span(floor_start));
  EXPECT_NEAR(slip_vector(lin).x(), 0.6, 1e-14);
}

TEST(CarryTangential, KeepsLengthAndDirection)
{
  Random random(3);
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    const ContactLinearisation from = make_case("triangle", seed, true).linearise(make_case("triangle", seed, true).x);
    const ContactLinearisation to = make_case("sphere", seed, true).linearise(make_case("sphere", seed, true).x);
    const std::array<double, 2> force{uniform(random, -1, 1), uniform(random, -1, 1)};
    const auto there = carry_tangential(force, from.normal, from.tangent, to);
    EXPECT_NEAR(std::hypot(there[0], there[1]), std::hypot(force[0], force[1]), 1e-14);
    const auto back = carry_tangential(there, to.normal, to.tangent, from);
    EXPECT_NEAR(back[0], force[0], 1e-13);
    EXPECT_NEAR(back[1], force[1], 1e-13);
    // Along the fold between the two faces a force is the same vector on either side.
    const Vector3d fold = from.normal.cross(to.normal).normalized();
    const auto along =
        carry_tangential({fold.dot(from.tangent[0]), fold.dot(from.tangent[1])}, from.normal, from.tangent, to);
    EXPECT_LT((along[0] * to.tangent[0] + along[1] * to.tangent[1] - fold).norm(), 1e-12);
  }
}

TEST(CarryTangential, OntoAnOppositeFaceKeepsTheLength)
{
  const ContactLinearisation to = make_case("plane", 1, true).linearise(make_case("plane", 1, true).x);
  const auto there = carry_tangential({3, 4}, -to.normal, to.tangent, to);
  EXPECT_NEAR(std::hypot(there[0], there[1]), 5, 1e-14);
}

TEST(CarryTangential, NothingChangesInThePlane)
{
  const ContactLinearisation to = make_case("segment", 1, true).linearise(make_case("segment", 1, true).x);
  EXPECT_EQ(carry_tangential({3, 0}, Vector3d::UnitX(), {Vector3d::UnitY(), Vector3d::Zero()}, to)[0], 3);
}

TEST(Degenerate, CollapsedFacesAreNumericalFailures)
{
  const VectorXd x = vector({.1, .1}), point = vector({1, 1, 1, 1});
  EXPECT_THROW(linearise_finite(2, span(x), span(point), span(x), span(point), {}), NumericalFailure);
  const VectorXd x3 = vector({.1, .1, .1}), line = vector({0, 0, 0, 1, 1, 1, 2, 2, 2});
  EXPECT_THROW(linearise_finite(3, span(x3), span(line), span(x3), span(line), {}), NumericalFailure);
  const VectorXd line4 = vector({0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3});
  EXPECT_THROW(linearise_finite(3, span(x3), span(line4), span(x3), span(line4), {}), NumericalFailure);
}

TEST(Degenerate, CentreOfASphereAndApexOfACone)
{
  const VectorXd origin = VectorXd::Zero(3), below = vector({0, -0.2, 0});
  const Shape sphere{ShapeType::sphere, {}, {0, 1, 0}, 1}, cylinder{ShapeType::cylinder, {}, {0, 1, 0}, 1};
  const auto against = [&](const Shape &shape, const VectorXd &x)
  { return linearise_shape(3, false, shape, span(x), span(origin), span(x), span(origin)); };
  EXPECT_THROW(against(sphere, origin), NumericalFailure);
  EXPECT_THROW(against(cylinder, below), NumericalFailure);
  const Shape cone{ShapeType::cone, {}, {0, 1, 0}, 0, 1};
  EXPECT_LT((against(cone, below).normal - Vector3d(0, -1, 0)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(against(cone, below).gap, 0.2);
  EXPECT_DOUBLE_EQ(against(cone, -below).gap, -0.2);
  EXPECT_TRUE(against(cone, origin).gap_direction_gradient.isZero());
}
} // namespace
} // namespace amontons::test
