#include "amontons/surface/normals.h"

#include <Eigen/Geometry>

#include <cmath>

namespace amontons
{
namespace
{
Eigen::Vector3d place(std::span<const double> x, int dim, Index node)
{
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (int c = 0; c < dim; ++c)
    out[c] = x[static_cast<std::size_t>(node) * dim + c];
  return out;
}

/// Normal of a face at one of its corners, as long as its weight in the node's average.
Eigen::Vector3d weighted_normal(const Surface &surface, std::span<const double> x, Index f, std::size_t corner)
{
  const auto nodes = surface.face(f);
  if (surface.dim == 2)
  {
    const Eigen::Vector3d edge = place(x, 2, nodes[1]) - place(x, 2, nodes[0]);
    return Eigen::Vector3d(edge[1], -edge[0], 0) / edge.squaredNorm();
  }
  const std::size_t n = nodes.size();
  const Eigen::Vector3d here = place(x, 3, nodes[corner]);
  const Eigen::Vector3d next = place(x, 3, nodes[(corner + 1) % n]) - here;
  const Eigen::Vector3d last = place(x, 3, nodes[(corner + n - 1) % n]) - here;
  return next.cross(last) / (next.squaredNorm() * last.squaredNorm());
}
} // namespace

std::vector<double> smoothed_normals(const Surface &surface, std::span<const double> x, double sharp_angle)
{
  const int dim = surface.dim;
  const double least_cosine = std::cos(sharp_angle);
  std::vector<Eigen::Vector3d> own(surface.face_nodes.size());
  for (Index f = 0; f < surface.n_faces(); ++f)
    for (std::size_t k = 0; k < surface.face(f).size(); ++k)
      own[surface.face_offsets[f] + k] = weighted_normal(surface, x, f, k);

  std::vector<double> out(own.size() * dim);
  for (Index f = 0; f < surface.n_faces(); ++f)
    for (Index corner = surface.face_offsets[f]; corner < surface.face_offsets[f + 1]; ++corner)
    {
      const Eigen::Vector3d mine = own[corner].normalized();
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const Index other : surface.faces_of_node(surface.face_nodes[corner]))
        for (Index k = surface.face_offsets[other]; k < surface.face_offsets[other + 1]; ++k)
          if (surface.face_nodes[k] == surface.face_nodes[corner] && own[k].dot(mine) >= least_cosine * own[k].norm())
            sum += own[k];
      sum.normalize();
      for (int c = 0; c < dim; ++c)
        out[static_cast<std::size_t>(corner) * dim + c] = sum[c];
    }
  return out;
}
} // namespace amontons
