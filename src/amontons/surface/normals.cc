#include "amontons/surface/normals.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d place(std::span<const double> x, int dim, Index node)
{
  Vector3d out = Vector3d::Zero();
  for (int c = 0; c < dim; ++c)
    out[c] = x[static_cast<std::size_t>(node) * dim + c];
  return out;
}

/// A corner of a face and the ends of the two edges there; in the plane the face's two nodes.
struct Corner
{
  Index here, next, last;
};

Corner corner_of(const Surface &surface, Index f, Index at)
{
  const auto nodes = surface.face(f);
  const auto n = static_cast<Index>(nodes.size()), k = at - surface.face_offsets[f];
  if (surface.dim == 2)
    return {nodes[0], nodes[1], nodes[1]};
  return {nodes[k], nodes[(k + 1) % n], nodes[(k + n - 1) % n]};
}

/// Normal of a face at one of its corners, as long as its weight in the node's average.
Vector3d weighted_normal(int dim, std::span<const double> x, const Corner &corner)
{
  const Vector3d here = place(x, dim, corner.here), next = place(x, dim, corner.next) - here;
  if (dim == 2)
    return Vector3d(next[1], -next[0], 0) / next.squaredNorm();
  const Vector3d last = place(x, dim, corner.last) - here;
  return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
}

/// Its derivatives by the vectors from `here` to `next` and to `last`.
std::array<Matrix3d, 2> weighted_normal_gradient(int dim, std::span<const double> x, const Corner &corner)
{
  const Vector3d normal = weighted_normal(dim, x, corner);
  const Vector3d here = place(x, dim, corner.here), next = place(x, dim, corner.next) - here;
  std::array<Matrix3d, 2> out{Matrix3d::Zero(), Matrix3d::Zero()};
  if (dim == 2)
  {
    out[0] = -2 / next.squaredNorm() * normal * next.transpose();
    out[0](0, 1) += 1 / next.squaredNorm();
    out[0](1, 0) -= 1 / next.squaredNorm();
    return out;
  }
  const Vector3d last = place(x, dim, corner.last) - here;
  const double scale = 1 / (next.squaredNorm() * last.squaredNorm());
  for (int c = 0; c < 3; ++c)
  {
    out[0].col(c) = scale * Vector3d::Unit(c).cross(last) - 2 * next[c] / next.squaredNorm() * normal;
    out[1].col(c) = scale * next.cross(Vector3d::Unit(c)) - 2 * last[c] / last.squaredNorm() * normal;
  }
  return out;
}

/// visit(face, corner) for the corners round a corner's node whose normals are averaged with its own.
/// @param own weighted_normal of a face's corner
template<class Own, class Visit>
void visit_averaged(const Surface &surface, double sharp_angle, Index f, Index corner, const Own &own, Visit &&visit)
{
  const double least_cosine = std::cos(sharp_angle);
  const Vector3d mine = own(f, corner).normalized();
  for (const Index other : surface.faces_of_node(surface.face_nodes[corner]))
    for (Index k = surface.face_offsets[other]; k < surface.face_offsets[other + 1]; ++k)
    {
      if (surface.face_nodes[k] != surface.face_nodes[corner])
        continue;
      const Vector3d theirs = own(other, k);
      if (theirs.dot(mine) >= least_cosine * theirs.norm())
        visit(other, k, theirs);
    }
}
} // namespace

std::vector<double> smoothed_normals(const Surface &surface, std::span<const double> x, double sharp_angle)
{
  const int dim = surface.dim;
  std::vector<Vector3d> own(surface.face_nodes.size());
  for (Index f = 0; f < surface.n_faces(); ++f)
    for (Index k = surface.face_offsets[f]; k < surface.face_offsets[f + 1]; ++k)
      own[k] = weighted_normal(dim, x, corner_of(surface, f, k));

  std::vector<double> out(own.size() * dim);
  for (Index f = 0; f < surface.n_faces(); ++f)
    for (Index corner = surface.face_offsets[f]; corner < surface.face_offsets[f + 1]; ++corner)
    {
      Vector3d sum = Vector3d::Zero();
      visit_averaged(
          surface, sharp_angle, f, corner, [&](Index, Index k) { return own[k]; },
          [&](Index, Index, const Vector3d &normal) { sum += normal; });
      sum.normalize();
      for (int c = 0; c < dim; ++c)
        out[static_cast<std::size_t>(corner) * dim + c] = sum[c];
    }
  return out;
}

NormalGradient smoothed_normal_gradient(const Surface &surface, std::span<const double> x, double sharp_angle, Index f,
                                        Index corner)
{
  const int dim = surface.dim;
  NormalGradient out;
  Vector3d sum = Vector3d::Zero();
  std::vector<Corner> corners;
  visit_averaged(
      surface, sharp_angle, f, corner,
      [&](Index face, Index k) { return weighted_normal(dim, x, corner_of(surface, face, k)); },
      [&](Index face, Index k, const Vector3d &normal)
      {
        sum += normal;
        corners.push_back(corner_of(surface, face, k));
        out.nodes.insert(out.nodes.end(), {corners.back().here, corners.back().next, corners.back().last});
      });
  std::sort(out.nodes.begin(), out.nodes.end());
  out.nodes.erase(std::unique(out.nodes.begin(), out.nodes.end()), out.nodes.end());

  out.gradient = Eigen::MatrixXd::Zero(dim, dim * static_cast<Eigen::Index>(out.nodes.size()));
  const double length = sum.norm();
  const Matrix3d turning = (Matrix3d::Identity() - sum * sum.transpose() / (length * length)) / length;
  const auto add = [&](Index node, const Matrix3d &by)
  {
    const auto at = std::lower_bound(out.nodes.begin(), out.nodes.end(), node) - out.nodes.begin();
    out.gradient.middleCols(dim * at, dim) += (turning * by).topLeftCorner(dim, dim);
  };
  for (const Corner &at : corners)
  {
    const auto [by_next, by_last] = weighted_normal_gradient(dim, x, at);
    add(at.next, by_next);
    add(at.last, by_last);
    add(at.here, -(by_next + by_last));
  }
  return out;
}
} // namespace amontons
