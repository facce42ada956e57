#pragma once
#include "amontons/surface/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace amontons::test
{
using Point = std::array<double, 3>;

/// A chain of segments through the given points of the plane, outward normal on the right; closed: last to first too.
inline Surface chain(const std::vector<std::array<double, 2>> &points, bool closed = false)
{
  Surface surface;
  surface.dim = 2;
  const auto n = static_cast<Index>(points.size());
  for (Index i = 0; i < n; ++i)
  {
    surface.node_ids.push_back(i);
    surface.reference.insert(surface.reference.end(), points[i].begin(), points[i].end());
    if (i + 1 < n || closed)
    {
      surface.face_nodes.insert(surface.face_nodes.end(), {i, (i + 1) % n});
      surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
      surface.face_ids.push_back(i);
    }
  }
  surface.build_adjacency();
  return surface;
}

/// n segments along the image of [0, 1].
inline Surface curve(int n, const std::function<std::array<double, 2>(double)> &map, bool closed = false)
{
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i < n + (closed ? 0 : 1); ++i)
    points.push_back(map(static_cast<double>(i) / n));
  return chain(points, closed);
}

/// n x m quadrilaterals (or twice as many triangles) on the image of [0, 1]^2; normal along d/ds x d/dt. `wrap` joins
/// s = 1 to s = 0 and t = 1 to t = 0.
inline Surface sheet(int n, int m, bool triangles, const std::function<Point(double, double)> &map, bool wrap = false)
{
  Surface surface;
  surface.dim = 3;
  const int n_s = wrap ? n : n + 1, n_t = wrap ? m : m + 1;
  for (int j = 0; j < n_t; ++j)
    for (int i = 0; i < n_s; ++i)
    {
      const Point x = map(static_cast<double>(i) / n, static_cast<double>(j) / m);
      surface.node_ids.push_back(j * n_s + i);
      surface.reference.insert(surface.reference.end(), x.begin(), x.end());
    }
  const auto add = [&surface](std::initializer_list<Index> nodes)
  {
    surface.face_nodes.insert(surface.face_nodes.end(), nodes);
    surface.face_offsets.push_back(static_cast<Index>(surface.face_nodes.size()));
    surface.face_ids.push_back(static_cast<GlobalIndex>(surface.face_ids.size()));
  };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i)
    {
      const Index a = j * n_s + i, b = j * n_s + (i + 1) % n_s, d = (j + 1) % n_t * n_s + i;
      const Index c = (j + 1) % n_t * n_s + (i + 1) % n_s;
      if (!triangles)
        add({a, b, c, d});
      else if ((i + j) % 2 == 0)
      {
        add({a, b, c});
        add({a, c, d});
      }
      else
      {
        add({a, b, d});
        add({b, c, d});
      }
    }
  surface.build_adjacency();
  return surface;
}

/// The same surface with nodes and faces numbered at random (faces' ids too).
inline Surface shuffled(const Surface &surface, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<Index> place(surface.node_ids.size()), faces(surface.face_ids.size());
  std::iota(place.begin(), place.end(), 0);
  std::iota(faces.begin(), faces.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::shuffle(faces.begin(), faces.end(), random);
  Surface result;
  result.dim = surface.dim;
  result.node_ids.resize(place.size());
  result.reference.resize(surface.reference.size());
  for (std::size_t i = 0; i < place.size(); ++i)
  {
    result.node_ids[place[i]] = surface.node_ids[i];
    for (int c = 0; c < surface.dim; ++c)
      result.reference[place[i] * surface.dim + c] = surface.reference[i * surface.dim + c];
  }
  for (const Index f : faces)
  {
    for (const Index node : surface.face(f))
      result.face_nodes.push_back(place[node]);
    result.face_offsets.push_back(static_cast<Index>(result.face_nodes.size()));
    result.face_ids.push_back(static_cast<GlobalIndex>(result.face_ids.size()));
  }
  result.build_adjacency();
  return result;
}

/// Nodes with no faces.
inline Surface cloud(int dim, const std::vector<double> &x)
{
  Surface surface;
  surface.dim = dim;
  surface.reference = x;
  surface.node_ids.resize(x.size() / dim);
  std::iota(surface.node_ids.begin(), surface.node_ids.end(), 0);
  surface.build_adjacency();
  return surface;
}

/// Random points about random points of the surface's faces, at distances up to `spread`.
inline Surface cloud_about(const Surface &surface, int n, double spread, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::uniform_int_distribution<Index> any_face(0, surface.n_faces() - 1);
  std::vector<double> x;
  for (int i = 0; i < n; ++i)
  {
    const auto nodes = surface.face(any_face(random));
    std::vector<double> weights;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      weights.push_back(1.0001 + uniform(random));
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (int c = 0; c < surface.dim; ++c)
    {
      double value = spread * uniform(random);
      for (std::size_t k = 0; k < nodes.size(); ++k)
        value += weights[k] / sum * surface.reference[static_cast<std::size_t>(nodes[k]) * surface.dim + c];
      x.push_back(value);
    }
  }
  return cloud(surface.dim, x);
}

inline Point torus(double s, double t, double large, double small)
{
  const double a = 2 * std::numbers::pi * s, b = 2 * std::numbers::pi * t;
  return {(large + small * std::cos(b)) * std::cos(a), (large + small * std::cos(b)) * std::sin(a),
          small * std::sin(b)};
}
} // namespace amontons::test
