#include "amontons/surface/surface.h"

#include "amontons/surface/projection.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace amontons
{
namespace
{
// Integrals of N_i over a segment, times 2 pi r on a ring: exact, the integrand being a polynomial of degree 2.
void add_segment_areas(const FaceCoordinates &face, bool axisymmetric, std::array<double, 4> &areas)
{
  const double length = (face.x[1] - face.x[0]).norm();
  for (std::size_t i = 0; i < 2; ++i)
  {
    const double own_radius = face.x[i].x(), other_radius = face.x[1 - i].x();
    const double weight = axisymmetric ? 2 * std::numbers::pi * (2 * own_radius + other_radius) / 3 : 1.0;
    areas[i] = weight * length / 2;
  }
}

// Gauss, 3 x 3: exact on plane quadrilaterals, where the area element is linear in xi.
void add_quadrilateral_areas(const FaceCoordinates &face, std::array<double, 4> &areas)
{
  const double offset = std::sqrt(0.15);
  const std::array<double, 3> points{0.5 - offset, 0.5, 0.5 + offset};
  const std::array<double, 3> weights{5.0 / 18, 8.0 / 18, 5.0 / 18};
  for (std::size_t p = 0; p < 3; ++p)
    for (std::size_t q = 0; q < 3; ++q)
    {
      const LocalPoint xi{points[p], points[q]};
      const auto tangents = face_tangents(face, xi);
      const auto n = shape_functions(4, xi);
      const double area = weights[p] * weights[q] * tangents[0].cross(tangents[1]).norm();
      for (std::size_t i = 0; i < 4; ++i)
        areas[i] += area * n[i];
    }
}
} // namespace

void Surface::build_adjacency()
{
  node_face_offsets.assign(node_ids.size() + 1, 0);
  for (const Index node : face_nodes)
    ++node_face_offsets[node + 1];
  for (std::size_t node = 0; node < node_ids.size(); ++node)
    node_face_offsets[node + 1] += node_face_offsets[node];
  node_faces.resize(face_nodes.size());
  std::vector<Index> next(node_face_offsets.begin(), node_face_offsets.end() - 1);
  for (Index f = 0; f < n_faces(); ++f)
    for (const Index node : face(f))
      node_faces[next[node]++] = f;
}

std::vector<double> tributary_areas(const Surface &surface, bool axisymmetric)
{
  std::vector<double> result(surface.node_ids.size(), 0.0);
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const auto nodes = surface.face(f);
    const FaceCoordinates face = gather_face(surface.dim, nodes, surface.reference);
    std::array<double, 4> areas{0, 0, 0, 0};
    if (face.n_nodes == 2)
      add_segment_areas(face, axisymmetric, areas);
    else if (face.n_nodes == 3)
      areas.fill((face.x[1] - face.x[0]).cross(face.x[2] - face.x[0]).norm() / 6);
    else
      add_quadrilateral_areas(face, areas);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      result[nodes[i]] += areas[i];
  }
  return result;
}
} // namespace amontons
