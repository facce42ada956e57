#pragma once
#include "amontons/contact/linearisation.h"
#include "amontons/surface/projection.h"

#include <array>
#include <span>

/// What the kinematics needs of a face: shape functions and local frame for any scalar type, and the projection.
namespace amontons
{
template<class Scalar, int dim>
using Point = Eigen::Matrix<Scalar, dim, 1>;

/// Positions of the nodes of a face.
template<class Scalar, int dim, int n_nodes>
using FaceNodes = std::array<Point<Scalar, dim>, n_nodes>;

/// Local coordinates of a face: the face's own, or its tangent plane at the point `centre` of it, which stands in
/// for the extended face where projection on the bilinear extension fails.
struct Chart
{
  bool is_tangent_plane = false;
  std::array<double, 2> centre{0, 0};
};

/// Shape functions and their derivatives at a point; numbering as in surface/surface.h.
template<class Scalar, int n_nodes>
struct ShapeFunctions
{
  static constexpr int n_xi = n_nodes == 2 ? 1 : 2;
  std::array<Scalar, n_nodes> value;
  std::array<std::array<Scalar, n_nodes>, n_xi> derivative;
  /// d2N/dxi1 dxi2, the only second derivative there is: that of a bilinear face.
  std::array<double, n_nodes> mixed{};
};

namespace face_detail
{
template<class Scalar, int n_nodes>
ShapeFunctions<Scalar, n_nodes> own_shape_functions(const std::array<Scalar, 2> &xi)
{
  ShapeFunctions<Scalar, n_nodes> out;
  if constexpr (n_nodes == 2)
  {
    out.value = {1. - xi[0], xi[0]};
    out.derivative[0] = {-1., 1.};
  }
  else if constexpr (n_nodes == 3)
  {
    out.value = {1. - xi[0] - xi[1], xi[0], xi[1]};
    out.derivative[0] = {-1., 1., 0.};
    out.derivative[1] = {-1., 0., 1.};
  }
  else
  {
    const Scalar eta0 = 1. - xi[0], eta1 = 1. - xi[1], product = xi[0] * xi[1];
    out.value = {eta1 - xi[0] + product, xi[0] - product, product, xi[1] - product};
    out.derivative[0] = {-eta1, eta1, xi[1], -xi[1]};
    out.derivative[1] = {-eta0, -xi[0], xi[0], eta0};
    out.mixed = {1, -1, 1, -1};
  }
  return out;
}
} // namespace face_detail

template<int n_nodes, class Scalar>
ShapeFunctions<Scalar, n_nodes> shape_functions(const Chart &chart, const std::array<Scalar, 2> &xi)
{
  if (!chart.is_tangent_plane)
    return face_detail::own_shape_functions<Scalar, n_nodes>(xi);
  const auto at_centre = face_detail::own_shape_functions<double, n_nodes>(chart.centre);
  ShapeFunctions<Scalar, n_nodes> out;
  for (int i = 0; i < n_nodes; ++i)
  {
    out.value[i] = at_centre.value[i];
    for (int a = 0; a < out.n_xi; ++a)
    {
      out.derivative[a][i] = at_centre.derivative[a][i];
      out.value[i] += at_centre.derivative[a][i] * (xi[a] - chart.centre[a]);
    }
  }
  return out;
}

/// sum_i weights_i x_i
template<class Weight, class Scalar, int dim, std::size_t n_nodes>
Point<Scalar, dim> combine(const std::array<Weight, n_nodes> &weights,
                           const std::array<Point<Scalar, dim>, n_nodes> &nodes)
{
  Point<Scalar, dim> sum = weights[0] * nodes[0];
  for (std::size_t i = 1; i < n_nodes; ++i)
    sum += weights[i] * nodes[i];
  return sum;
}

/// Outward unit normal and orthonormal tangents of the linearisation's frame.
template<class Scalar, int dim>
struct Frame
{
  Point<Scalar, dim> normal;
  std::array<Point<Scalar, dim>, dim - 1> tangent;
};

template<class Scalar, int dim>
Scalar norm(const Point<Scalar, dim> &v)
{
  using std::sqrt;
  return sqrt(v.dot(v));
}

/// @param a local base vectors xbar_,a
template<class Scalar, int dim>
Frame<Scalar, dim> frame_of(const std::array<Point<Scalar, dim>, dim - 1> &a)
{
  Frame<Scalar, dim> frame;
  frame.tangent[0] = a[0] * (1. / norm<Scalar, dim>(a[0]));
  if constexpr (dim == 2)
    frame.normal = Point<Scalar, dim>(frame.tangent[0][1], -frame.tangent[0][0]);
  else
  {
    const Point<Scalar, dim> area = a[0].cross(a[1]);
    frame.normal = area * (1. / norm<Scalar, dim>(area));
    frame.tangent[1] = frame.normal.cross(frame.tangent[0]);
  }
  return frame;
}

/// Of the axes of coordinates the one farthest from n.
inline Eigen::Vector3d farthest_axis(const Eigen::Vector3d &n)
{
  Eigen::Index k = 0;
  n.cwiseAbs().minCoeff(&k);
  return Eigen::Vector3d::Unit(k);
}

/// Completes a frame from its normal and, in 3D, a vector whose part normal to n gives e_1.
template<class Scalar, int dim>
Frame<Scalar, dim> frame_from(const Point<Scalar, dim> &normal, const Point<Scalar, dim> &along)
{
  Frame<Scalar, dim> out{normal, {}};
  if constexpr (dim == 2)
    out.tangent[0] = Point<Scalar, dim>(-normal[1], normal[0]);
  else
  {
    const Point<Scalar, dim> tangent = along - normal * normal.dot(along);
    out.tangent[0] = tangent * (1. / norm<Scalar, dim>(tangent));
    out.tangent[1] = normal.cross(out.tangent[0]);
  }
  return out;
}

template<int dim, int n_nodes>
FaceNodes<double, dim, n_nodes> gather(std::span<const double> coordinates)
{
  FaceNodes<double, dim, n_nodes> nodes;
  for (int i = 0; i < n_nodes; ++i)
    nodes[i] = Eigen::Map<const Point<double, dim>>(coordinates.data() + i * dim);
  return nodes;
}

/// A point's projection on a face extended beyond its edges.
struct Projection
{
  Chart chart;
  std::array<double, 2> xi{0, 0};
};

/// Closest point of the extended face, xi not clamped, as detection finds it (surface/projection.h). Bilinear faces:
/// Newton from xi_guess, then from the closest point of the face; where that wanders off, the tangent plane at the
/// closest point stands in for the extended face.
/// @throws NumericalFailure if the face has no area
template<int dim, int n_nodes>
Projection project(const FaceNodes<double, dim, n_nodes> &face, const Point<double, dim> &x,
                   std::array<double, 2> xi_guess);

extern template Projection project<2, 2>(const FaceNodes<double, 2, 2> &, const Point<double, 2> &,
                                         std::array<double, 2>);
extern template Projection project<3, 3>(const FaceNodes<double, 3, 3> &, const Point<double, 3> &,
                                         std::array<double, 2>);
extern template Projection project<3, 4>(const FaceNodes<double, 3, 4> &, const Point<double, 3> &,
                                         std::array<double, 2>);
} // namespace amontons
