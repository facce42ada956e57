#include "amontons/base/error.h"
#include "amontons/contact/face.h"
#include "amontons/contact/kinematics.h"
#include "amontons/surface/dual.h"

#include <algorithm>

namespace amontons
{
namespace
{
/// Inverse of A_ab = m_ab - g kappa_ab.
template<class Scalar, int n_xi>
using Metric = std::array<std::array<Scalar, n_xi>, n_xi>;

template<class Scalar, int n_xi>
Metric<Scalar, n_xi> inverse(const Metric<Scalar, n_xi> &a)
{
  if constexpr (n_xi == 1)
    return {{{1. / a[0][0]}}};
  else
  {
    const Scalar scale = 1. / (a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    return {{{a[1][1] * scale, -a[0][1] * scale}, {-a[1][0] * scale, a[0][0] * scale}}};
  }
}

/// Normals at a face's nodes in the frame of the face's centre: tangents first, the normal last.
template<int dim, int n_nodes>
using LocalNormals = std::array<Point<double, dim>, n_nodes>;

template<class Scalar, int dim, int n_nodes>
Frame<Scalar, dim> central_frame(const FaceNodes<Scalar, dim, n_nodes> &face)
{
  constexpr double at = n_nodes == 3 ? 1. / 3 : 0.5;
  const auto shape = shape_functions<n_nodes>(Chart{}, std::array<Scalar, 2>{at, at});
  std::array<Point<Scalar, dim>, dim - 1> base;
  for (int a = 0; a < dim - 1; ++a)
    base[a] = combine(shape.derivative[a], face);
  return frame_of<Scalar, dim>(base);
}

/// The normal interpolated between the nodes' (held constant beyond the face), and the tangents turned with it by the
/// least rotation.
template<class Scalar, int dim, int n_nodes>
Frame<Scalar, dim> smooth_frame(const Frame<Scalar, dim> &frame, const FaceNodes<Scalar, dim, n_nodes> &face,
                                const std::array<Scalar, n_nodes> &weights, const LocalNormals<dim, n_nodes> &normals)
{
  const Frame<Scalar, dim> centre = central_frame<Scalar, dim, n_nodes>(face);
  Point<Scalar, dim> sum = centre.normal * Scalar(0.);
  for (int i = 0; i < n_nodes; ++i)
    if (value_of(weights[i]) > 0)
    {
      sum += weights[i] * (normals[i][dim - 1] * centre.normal);
      for (int a = 0; a < dim - 1; ++a)
        sum += weights[i] * (normals[i][a] * centre.tangent[a]);
    }
  Frame<Scalar, dim> out;
  out.normal = sum * (1. / norm<Scalar, dim>(sum));
  const Point<Scalar, dim> bisector = frame.normal + out.normal;
  const Scalar scale = 1. / (1. + frame.normal.dot(out.normal));
  for (int a = 0; a < dim - 1; ++a)
    out.tangent[a] = frame.tangent[a] - bisector * (frame.tangent[a].dot(out.normal) * scale);
  return out;
}

/// Gap, slip and their first variations at a given projection, for any scalar type. With T_a = [a_a, -N_i a_a],
/// N_a = [0, -N_i,a n] and D^a = A^ab (T_b - g N_b) = grad xi^a (Laursen, Simo 1993, IJNME 36), grad g_n = [n, -N_i n]
/// and the slip direction is (e_c . a_a) D^a.
template<class Scalar, int dim, int n_nodes>
struct FaceKinematics
{
  static constexpr int n_xi = dim - 1;
  static constexpr int n_dofs = dim * (1 + n_nodes);
  using Vector = Eigen::Matrix<Scalar, n_dofs, 1>;

  ShapeFunctions<Scalar, n_nodes> shape;
  std::array<Point<Scalar, dim>, n_xi> base;
  Frame<Scalar, dim> frame;
  Point<Scalar, dim> closest;
  Scalar gap;
  Metric<Scalar, n_xi> a_inverse;
  bool is_smooth;
  Frame<Scalar, dim> force_frame; ///< directions of the forces; `frame` but for smoothed normals

  /// @param normals null for the face's own normal
  FaceKinematics(const Chart &chart, const Point<Scalar, dim> &x, const FaceNodes<Scalar, dim, n_nodes> &face,
                 const std::array<Scalar, 2> &xi, const LocalNormals<dim, n_nodes> *normals)
    : shape(shape_functions<n_nodes>(chart, xi))
  {
    for (int a = 0; a < n_xi; ++a)
      base[a] = combine(shape.derivative[a], face);
    frame = frame_of<Scalar, dim>(base);
    closest = combine(shape.value, face);
    gap = frame.normal.dot(x - closest);
    Metric<Scalar, n_xi> a_matrix;
    for (int a = 0; a < n_xi; ++a)
      for (int b = 0; b < n_xi; ++b)
        a_matrix[a][b] = base[a].dot(base[b]);
    if (n_nodes == 4 && !chart.is_tangent_plane)
    {
      const Scalar curvature = gap * frame.normal.dot(combine(shape.mixed, face));
      a_matrix[0][n_xi - 1] -= curvature;
      a_matrix[n_xi - 1][0] -= curvature;
    }
    a_inverse = inverse<Scalar, n_xi>(a_matrix);
    is_smooth = normals != nullptr;
    force_frame = is_smooth ? smooth_frame<Scalar, dim, n_nodes>(frame, face, shape.value, *normals) : frame;
  }

  /// A unit force along `direction` on the impactor node and its reaction on the face.
  [[nodiscard]] Vector opposed(const Point<Scalar, dim> &direction) const
  {
    Vector out;
    out.template head<dim>() = direction;
    for (int i = 0; i < n_nodes; ++i)
      out.template segment<dim>(dim * (1 + i)) = direction * -shape.value[i];
    return out;
  }

  [[nodiscard]] Vector gap_gradient() const { return opposed(frame.normal); }
  [[nodiscard]] Vector gap_direction() const { return opposed(force_frame.normal); }

  /// sum_a weight_a grad xi^a
  [[nodiscard]] Vector projection_gradient(const std::array<Scalar, n_xi> &weight) const
  {
    std::array<Scalar, n_xi> raised;
    for (int b = 0; b < n_xi; ++b)
    {
      raised[b] = weight[0] * a_inverse[0][b];
      for (int a = 1; a < n_xi; ++a)
        raised[b] += weight[a] * a_inverse[a][b];
    }
    Point<Scalar, dim> along = raised[0] * base[0];
    for (int b = 1; b < n_xi; ++b)
      along += raised[b] * base[b];
    Vector out;
    out.template head<dim>() = along;
    for (int i = 0; i < n_nodes; ++i)
    {
      Scalar turning = raised[0] * shape.derivative[0][i];
      for (int b = 1; b < n_xi; ++b)
        turning += raised[b] * shape.derivative[b][i];
      out.template segment<dim>(dim * (1 + i)) = frame.normal * (gap * turning) - along * shape.value[i];
    }
    return out;
  }

  [[nodiscard]] Vector slip_direction(int c) const
  {
    if (is_smooth)
      return opposed(force_frame.tangent[c]);
    std::array<Scalar, n_xi> weight;
    for (int a = 0; a < n_xi; ++a)
      weight[a] = frame.tangent[c].dot(base[a]);
    return projection_gradient(weight);
  }
};

template<int n>
void split(const Eigen::Matrix<Dual<n>, n, 1> &vector, ContactVector &value, ContactMatrix &gradient)
{
  value.resize(n);
  gradient.resize(n, n);
  for (int i = 0; i < n; ++i)
  {
    value[i] = vector[i].value;
    gradient.row(i) = Eigen::Map<const Eigen::Matrix<double, 1, n>>(vector[i].gradient.data());
  }
}

/// Shape functions at alpha, the projection of the slip's origin on the face as it was at tau.
template<int dim, int n_nodes>
std::array<double, n_nodes> origin_weights(std::span<const double> slip_origin, std::span<const double> face_at_start,
                                           std::array<double, 2> xi_guess)
{
  const Point<double, dim> origin = Eigen::Map<const Point<double, dim>>(slip_origin.data());
  const auto alpha = project<dim, n_nodes>(gather<dim, n_nodes>(face_at_start), origin, xi_guess);
  return shape_functions<n_nodes>(alpha.chart, alpha.xi).value;
}

/// @param normals [n_nodes * dim]
template<int dim, int n_nodes>
LocalNormals<dim, n_nodes> local_normals(std::span<const double> normals, std::span<const double> face_at_start)
{
  const Frame<double, dim> frame = central_frame<double, dim, n_nodes>(gather<dim, n_nodes>(face_at_start));
  LocalNormals<dim, n_nodes> out;
  for (int i = 0; i < n_nodes; ++i)
  {
    const Point<double, dim> normal = Eigen::Map<const Point<double, dim>>(normals.data() + i * dim);
    for (int a = 0; a < dim - 1; ++a)
      out[i][a] = frame.tangent[a].dot(normal);
    out[i][dim - 1] = frame.normal.dot(normal);
  }
  return out;
}

template<int dim, int n_nodes>
ContactLinearisation linearise(std::span<const double> impactor, std::span<const double> face_coordinates,
                               std::span<const double> slip_origin, std::span<const double> face_at_start,
                               std::array<double, 2> xi_guess, std::span<const double> normals_at_start)
{
  constexpr int n_dofs = dim * (1 + n_nodes), n_xi = dim - 1;
  AMONTONS_ASSERT(impactor.size() == dim && slip_origin.size() == dim);
  AMONTONS_ASSERT(face_at_start.size() == face_coordinates.size());
  const auto nodes = gather<dim, n_nodes>(face_coordinates);
  const Point<double, dim> x = Eigen::Map<const Point<double, dim>>(impactor.data());
  const Projection projection = project<dim, n_nodes>(nodes, x, xi_guess);
  const auto weights = origin_weights<dim, n_nodes>(slip_origin, face_at_start, projection.xi);

  LocalNormals<dim, n_nodes> local;
  const LocalNormals<dim, n_nodes> *normals = nullptr;
  if (!normals_at_start.empty())
  {
    local = local_normals<dim, n_nodes>(normals_at_start, face_at_start);
    normals = &local;
  }

  // xi is an implicit function of the positions: its gradient in closed form, then everything in dual numbers.
  const FaceKinematics<double, dim, n_nodes> at(projection.chart, x, nodes, projection.xi, normals);
  std::array<Dual<n_dofs>, 2> xi{projection.xi[0], projection.xi[1]};
  for (int a = 0; a < n_xi; ++a)
  {
    std::array<double, n_xi> unit{};
    unit[a] = 1;
    const auto gradient = at.projection_gradient(unit);
    std::copy_n(gradient.data(), n_dofs, xi[a].gradient.begin());
  }
  Point<Dual<n_dofs>, dim> x_dual;
  FaceNodes<Dual<n_dofs>, dim, n_nodes> nodes_dual;
  for (int k = 0; k < dim; ++k)
  {
    x_dual[k] = Dual<n_dofs>::variable(x[k], k);
    for (int i = 0; i < n_nodes; ++i)
      nodes_dual[i][k] = Dual<n_dofs>::variable(nodes[i][k], dim * (1 + i) + k);
  }
  const FaceKinematics<Dual<n_dofs>, dim, n_nodes> dual(projection.chart, x_dual, nodes_dual, xi, normals);
  const Point<Dual<n_dofs>, dim> chord = dual.closest - combine(weights, nodes_dual);

  ContactLinearisation out;
  out.dim = dim;
  out.gap = at.gap;
  out.xi = projection.xi;
  out.normal.template head<dim>() = at.frame.normal;
  const auto gap_gradient = at.gap_gradient();
  out.gap_gradient = gap_gradient;
  split<n_dofs>(dual.gap_direction(), out.gap_direction, out.gap_direction_gradient);
  for (int c = 0; c < n_xi; ++c)
  {
    out.tangent[c].setZero();
    out.tangent[c].template head<dim>() = at.frame.tangent[c];
    const Dual<n_dofs> slip = dual.frame.tangent[c].dot(chord);
    out.slip[c] = slip.value;
    out.slip_gradient[c] = Eigen::Map<const Eigen::Matrix<double, n_dofs, 1>>(slip.gradient.data());
    split<n_dofs>(dual.slip_direction(c), out.slip_direction[c], out.slip_direction_gradient[c]);
  }
  return out;
}

/// Local coordinates and gap of a projection.
template<int dim, int n_nodes>
std::pair<Projection, double> projected_gap(const Point<double, dim> &x, const FaceNodes<double, dim, n_nodes> &face,
                                            std::array<double, 2> xi_guess)
{
  const Projection projection = project<dim, n_nodes>(face, x, xi_guess);
  return {projection, FaceKinematics<double, dim, n_nodes>(projection.chart, x, face, projection.xi, nullptr).gap};
}

template<int dim, int n_nodes>
Eigen::Vector3d closing_origin(std::span<const double> impactor, std::span<const double> face,
                               std::span<const double> impactor_at_start, std::span<const double> face_at_start,
                               std::array<double, 2> xi_guess)
{
  AMONTONS_ASSERT(impactor.size() == dim && impactor_at_start.size() == dim && face_at_start.size() == face.size());
  const Point<double, dim> x = Eigen::Map<const Point<double, dim>>(impactor.data());
  const Point<double, dim> x_start = Eigen::Map<const Point<double, dim>>(impactor_at_start.data());
  const auto nodes_start = gather<dim, n_nodes>(face_at_start);
  const auto [now, gap_now] = projected_gap<dim, n_nodes>(x, gather<dim, n_nodes>(face), xi_guess);
  const auto [start, gap_start] = projected_gap<dim, n_nodes>(x_start, nodes_start, now.xi);
  const double fraction = closing_fraction(gap_start, gap_now);
  // Interpolated as a point of the face, by its weights: whatever the target does meanwhile drops out.
  const auto weights_now = shape_functions<n_nodes>(now.chart, now.xi).value;
  auto weights = shape_functions<n_nodes>(start.chart, start.xi).value;
  for (int i = 0; i < n_nodes; ++i)
    weights[i] += fraction * (weights_now[i] - weights[i]);
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  origin.head<dim>() = combine(weights, nodes_start);
  return origin;
}
} // namespace

double closing_fraction(double gap_start, double gap_now)
{
  if (gap_start <= 0)
    return 0;
  return gap_now >= 0 ? 1 : gap_start / (gap_start - gap_now);
}

ContactLinearisation linearise_finite(int dim, std::span<const double> impactor, std::span<const double> face,
                                      std::span<const double> slip_origin, std::span<const double> face_at_start,
                                      std::array<double, 2> xi_guess, std::span<const double> normals_at_start)
{
  if (dim == 2 && face.size() == 4)
    return linearise<2, 2>(impactor, face, slip_origin, face_at_start, xi_guess, normals_at_start);
  if (dim == 3 && face.size() == 9)
    return linearise<3, 3>(impactor, face, slip_origin, face_at_start, xi_guess, normals_at_start);
  AMONTONS_ASSERT(dim == 3 && face.size() == 12);
  return linearise<3, 4>(impactor, face, slip_origin, face_at_start, xi_guess, normals_at_start);
}

Eigen::Vector3d closing_origin_finite(int dim, std::span<const double> impactor, std::span<const double> face,
                                      std::span<const double> impactor_at_start, std::span<const double> face_at_start,
                                      std::array<double, 2> xi_guess)
{
  if (dim == 2 && face.size() == 4)
    return closing_origin<2, 2>(impactor, face, impactor_at_start, face_at_start, xi_guess);
  if (dim == 3 && face.size() == 9)
    return closing_origin<3, 3>(impactor, face, impactor_at_start, face_at_start, xi_guess);
  AMONTONS_ASSERT(dim == 3 && face.size() == 12);
  return closing_origin<3, 4>(impactor, face, impactor_at_start, face_at_start, xi_guess);
}
} // namespace amontons
