// Integrals over overlaps: their values against the points of the overlap, their derivatives against differences of the
// values as the faces' nodes move in space.
#include "amontons/surface/overlap_integrals.h"

#include "amontons/surface/quadrature.h"
#include "overlap_points.h"
#include "surfaces.h"

#include <gtest/gtest.h>

namespace amontons::test
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

struct TwoFaces
{
  FaceCoordinates impactor, target;

  void move(double h, const VectorXd &direction)
  {
    Eigen::Index at = 0;
    for (FaceCoordinates *face : {&impactor, &target})
      for (int i = 0; i < face->n_nodes; ++i, at += 3)
        face->x[i] += h * direction.segment<3>(at);
  }
};

double uniform(std::mt19937 &random)
{
  return std::uniform_real_distribution<double>(-1, 1)(random);
}

/// A warped face of the unit square's size, its corners shifted by up to `distortion`.
FaceCoordinates face_at(double x, double y, double z, int n_nodes, bool down, double distortion, std::mt19937 &random)
{
  const std::array<Vector2d, 4> corners{Vector2d(0, 0), {1, 0}, {1, 1}, {0, 1}};
  FaceCoordinates face;
  face.n_nodes = n_nodes;
  for (int i = 0; i < n_nodes; ++i)
    face.x[down ? n_nodes - 1 - i : i] = Vector3d(x + corners[i].x(), y + corners[i].y(), z) +
                                         distortion * Vector3d(uniform(random), uniform(random), uniform(random));
  return face;
}

OverlapIntegrals integrals_of(const TwoFaces &faces, bool with_gradient)
{
  OverlapIntegrals out;
  integrate_overlap(ProjectionPlane(faces.impactor), faces.target, with_gradient, out);
  return out;
}

/// How the variables of the derivatives change as the nodes move.
Eigen::Matrix<double, OverlapIntegrals::n_variables, 1> change_of_variables(const TwoFaces &faces,
                                                                            const VectorXd &direction)
{
  const ProjectionPlane plane(faces.impactor);
  Eigen::Matrix<double, OverlapIntegrals::n_variables, 1> out;
  out.setZero();
  const int n = faces.impactor.n_nodes;
  for (int i = 0; i < n + faces.target.n_nodes; ++i)
    for (int c = 0; c < 2; ++c)
      out[(i < n ? 2 * i : OverlapIntegrals::n_own + 2 * (i - n)) + c] =
          plane.base()[c].dot(direction.segment<3>(3 * i));
  Eigen::Matrix<double, 12, 1> own = Eigen::Matrix<double, 12, 1>::Zero();
  own.head(3 * n) = direction.head(3 * n);
  out.segment<2>(8) = plane.tilt() * own;
  return out;
}

Matrix4d square(const Eigen::Matrix<double, 16, 1> &rows)
{
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
}

TEST(OverlapIntegrals, SumOverThePointsOfTheOverlap)
{
  std::mt19937 random(2);
  for (int trial = 0; trial < 40; ++trial)
  {
    const TwoFaces faces{
        face_at(0, 0, 0, 3 + trial % 2, false, 0.1, random),
        face_at(0.4 * uniform(random), 0.4 * uniform(random), 0.2, 3 + trial / 2 % 2, true, 0.1, random)};
    const OverlapIntegrals integrals = integrals_of(faces, false);
    const FaceOverlap overlap = overlap_of_faces(faces.impactor, faces.target);
    Matrix4d mass = Matrix4d::Zero(), mixed = Matrix4d::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const OverlapPoint &point : overlap.points)
    {
      const auto n = shape_functions(faces.impactor.n_nodes, point.impactor),
                 m = shape_functions(faces.target.n_nodes, point.target);
      const Eigen::Map<const Eigen::Vector4d> own(n.data()), other(m.data());
      mass += point.weight * own * own.transpose();
      mixed += point.weight * own * other.transpose();
      least = std::min(least, std::abs(point.gap));
    }
    EXPECT_GT(integrals.size, 0);
    EXPECT_EQ(integrals.size, overlap.size);
    EXPECT_NEAR(integrals.least_gap, least, 1e-15);
    EXPECT_LT((integrals.mass - mass).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((integrals.mixed - mixed).cwiseAbs().maxCoeff(), 1e-15);
  }
}

TEST(OverlapIntegrals, DerivativesMatchDifferences)
{
  std::mt19937 random(4);
  constexpr double h = 1e-5;
  for (int trial = 0; trial < 60; ++trial)
  {
    const TwoFaces faces{
        face_at(0, 0, 0, 3 + trial % 2, false, 0.1, random),
        face_at(0.4 * uniform(random), 0.4 * uniform(random), 0.2, 3 + trial / 2 % 2, true, 0.1, random)};
    const VectorXd direction = VectorXd::NullaryExpr(3 * (faces.impactor.n_nodes + faces.target.n_nodes),
                                                     [&](Eigen::Index) { return uniform(random); });
    TwoFaces up = faces, down = faces;
    up.move(h, direction);
    down.move(-h, direction);
    const OverlapIntegrals at = integrals_of(faces, true), above = integrals_of(up, false),
                           below = integrals_of(down, false);
    const auto change = change_of_variables(faces, direction);
    EXPECT_LT(((above.mass - below.mass) / (2 * h) - square(at.mass_gradient * change)).cwiseAbs().maxCoeff(), 2e-8);
    EXPECT_LT(((above.mixed - below.mixed) / (2 * h) - square(at.mixed_gradient * change)).cwiseAbs().maxCoeff(), 2e-8);
    EXPECT_LT((integrals_of(faces, false).mixed - at.mixed).cwiseAbs().maxCoeff(), 1e-16);
  }
}

// Four targets round a corner of the impactor, whose edges run along its edges or only cross there: on whichever side
// they lie by round-off, together they cover the impactor's face, and as they all move none of its mass changes.
TEST(OverlapIntegrals, CoincidentEdgesEndAtTheImpactors)
{
  std::mt19937 random(6);
  const FaceCoordinates impactor = face_at(0, 0, 0, 4, false, 0, random);
  for (const double off : {0.0, 1e-16, -1e-16, 1e-13, -1e-13, 1e-11, -1e-11, 1e-9, -1e-9})
    for (const double turn : {0.0, 0.6})
    {
      Matrix4d mass = Matrix4d::Zero();
      Eigen::Matrix<double, 16, 8> by_target = Eigen::Matrix<double, 16, 8>::Zero();
      for (const double x : {-1.0, 0.0})
        for (const double y : {-1.0, 0.0})
        {
          FaceCoordinates target = face_at(x, y, 0.1, 4, true, 0, random);
          const Vector3d corner(0, 0, 0.1);
          for (Vector3d &node : target.x)
            node = corner + Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * (1.5 * (node - corner)) +
                   Vector3d(off, off / 3, 0);
          OverlapIntegrals integrals;
          integrate_overlap(ProjectionPlane(impactor), target, true, integrals);
          mass += integrals.mass;
          // All nodes move alike.
          for (Eigen::Index node = 0; node < 4; ++node)
            by_target.leftCols<2>() += integrals.mass_gradient.middleCols<2>(OverlapIntegrals::n_own + 2 * node);
        }
      EXPECT_NEAR(mass.sum(), 1, 1e-9) << off << ' ' << turn;
      EXPECT_LT(by_target.cwiseAbs().maxCoeff(), 1e-9) << off << ' ' << turn;
    }
}

TEST(OverlapIntegrals, TheRuleIsGoodOnDistortedQuadrilaterals)
{
  std::mt19937 random(8);
  for (const double distortion : {1e-9, 1e-4, 0.01, 0.05, 0.15})
    for (int trial = 0; trial < 20; ++trial)
    {
      const ProjectionPlane plane(face_at(0, 0, 0, 4, false, distortion, random));
      const FlatFace own = plane.own();
      const FlatFace other = plane.flat(face_at(0.3, 0.2, 0.1, 4, true, distortion, random));
      const FlatPolygon part = shared_part(own, other);
      const auto integral = [&](int n)
      {
        Matrix4d out = Matrix4d::Zero();
        for (int i = 2; i < part.n; ++i)
          for (const TrianglePoint &point : triangle_rule(n))
          {
            const FlatShape a = own.shape(part.triangle(i).at(point.share), false),
                            b = other.shape(part.triangle(i).at(point.share), false);
            out += point.weight * part.triangle(i).twice_area * Eigen::Map<const Eigen::Vector4d>(a.value.data()) *
                   Eigen::Map<const Eigen::RowVector4d>(b.value.data());
          }
        return out;
      };
      EXPECT_LT((integral(n_along_side(own, other, false)) - integral(16)).cwiseAbs().maxCoeff(), 1e-9) << distortion;
    }
}

TEST(OverlapIntegrals, FlatFacesFindTheirLocalCoordinates)
{
  std::mt19937 random(9);
  for (int trial = 0; trial < 200; ++trial)
  {
    const FaceCoordinates face = face_at(0, 0, 0, 3 + trial % 2, trial / 2 % 2 == 1, 0.25, random);
    const FlatFace flat(face, Vector3d::Zero(), {Vector3d::UnitX(), Vector3d::UnitY()});
    if (!flat.convex())
      continue;
    const double s = 0.5 + 0.5 * uniform(random), t = (trial % 2 == 1 ? 1 : 1 - s) * (0.5 + 0.5 * uniform(random));
    const LocalPoint found = flat.local(face_point(face, {s, t}).head<2>());
    EXPECT_NEAR(found[0], s, 1e-13);
    EXPECT_NEAR(found[1], t, 1e-13);
  }
}
} // namespace
} // namespace amontons::test
