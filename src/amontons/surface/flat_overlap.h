#pragma once
#include "amontons/surface/projection.h"

#include <array>

/// Faces in space seen in a plane: where an impactor face and a target face, projected on the impactor's plane,
/// overlap.
namespace amontons
{
/// Shape functions of a face at a point of the plane; zero beyond its nodes.
struct FlatShape
{
  LocalPoint xi{0, 0};
  std::array<double, 4> value{};
  std::array<std::array<double, 4>, 2> gradient{}; ///< [component in the plane][node]
};

/// A face seen in a plane of projection.
class FlatFace
{
public:
  /// @param base two orthonormal vectors of the plane through `origin`
  FlatFace(const FaceCoordinates &face, const Eigen::Vector3d &origin, const std::array<Eigen::Vector3d, 2> &base);

  [[nodiscard]] bool convex() const { return convex_; }
  [[nodiscard]] bool triangle() const { return n_ == 3; }
  [[nodiscard]] int n_nodes() const { return n_; }
  [[nodiscard]] const Eigen::Vector2d &node(int i) const { return x_[i]; }
  /// Of node i above the plane.
  [[nodiscard]] double height(int i) const { return height_[i]; }
  /// 0 for triangles and parallelograms, 1 where a corner becomes flat.
  [[nodiscard]] double distortion() const { return distortion_; }
  /// 1 where the nodes run counter-clockwise, else -1.
  [[nodiscard]] int sense() const { return sense_; }
  /// Local coordinates of a point of a convex face, in closed form.
  [[nodiscard]] LocalPoint local(const Eigen::Vector2d &y) const;
  /// Shape functions there, with their gradients where asked for.
  [[nodiscard]] FlatShape shape(const Eigen::Vector2d &y, bool with_gradient) const;
  [[nodiscard]] double height_at(const FlatShape &shape) const;

private:
  int n_, sense_ = 1;
  std::array<Eigen::Vector2d, 4> x_;
  std::array<double, 4> height_{};
  Eigen::Vector2d a_, b_, mixed_; ///< x = x_0 + xi_1 a + xi_2 b + xi_1 xi_2 mixed
  bool convex_ = false;
  double distortion_ = 0;
};

/// The plane through an impactor face's centre, normal to it there.
class ProjectionPlane
{
public:
  explicit ProjectionPlane(const FaceCoordinates &impactor);

  [[nodiscard]] const FaceCoordinates &face() const { return face_; }
  [[nodiscard]] const Eigen::Vector3d &normal() const { return normal_; }
  [[nodiscard]] const std::array<Eigen::Vector3d, 2> &base() const { return base_; }
  /// The impactor face in its plane.
  [[nodiscard]] const FlatFace &own() const { return own_; }
  [[nodiscard]] FlatFace flat(const FaceCoordinates &face) const { return {face, origin_, base_}; }
  /// How the plane turns: base . dn = tilt . dx, [2 x 12], dx of the impactor's nodes, zero beyond them.
  [[nodiscard]] Eigen::Matrix<double, 2, 12> tilt() const;

private:
  FaceCoordinates face_;
  Eigen::Vector3d origin_, normal_;
  std::array<Eigen::Vector3d, 2> base_;
  FlatFace own_;
};

/// The line from one node to another; 0 to 3 are the impactor's nodes, 4 to 7 the target's.
struct FlatLine
{
  int from = 0, to = 0;
};

/// A triangle in the plane of projection.
struct FlatTriangle
{
  std::array<Eigen::Vector2d, 3> corner;
  double twice_area;

  [[nodiscard]] Eigen::Vector2d at(const std::array<double, 3> &share) const
  {
    return share[0] * corner[0] + share[1] * corner[1] + share[2] * corner[2];
  }
};

/// A convex polygon in the plane of projection, counter-clockwise; corner i lies on the lines of sides i - 1 and i.
struct FlatPolygon
{
  static constexpr int max_corners = 16;
  int n = 0;
  std::array<Eigen::Vector2d, max_corners> corner;
  std::array<FlatLine, max_corners> side; ///< from corner i to the next

  void add(const Eigen::Vector2d &x, FlatLine along);
  [[nodiscard]] double area() const;
  /// Corners 0, i - 1 and i.
  [[nodiscard]] FlatTriangle triangle(int i) const;
};

/// The part that two faces share (Sutherland, Hodgman 1974). What lies within 1e-10 of the impactor's size of one of
/// its edges counts as on that edge: where edges of both coincide the part ends at the impactor's, whichever target is
/// asked.
/// @return no corners where they share nothing, or where `other` is not convex
/// @throws NumericalFailure if `own` is not convex
FlatPolygon shared_part(const FlatFace &own, const FlatFace &other);

/// Points along each side of a triangle's rule with which the products of two shape functions are integrated exactly on
/// triangles and parallelograms and to about 1e-10 on other quadrilaterals. The derivatives, too, where they are
/// wanted: they are those of a parallelogram that distorts.
int n_along_side(const FlatFace &own, const FlatFace &other, bool with_gradient);
} // namespace amontons
