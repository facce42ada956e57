#include "amontons/surface/overlap_integrals.h"

#include "amontons/surface/quadrature.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector2d;

constexpr int n_corners = 4, n_mass = 10, n_mixed = 16, n_integrals = n_mass + n_mixed;
/// The integrals of N_i N_k of one face, each once.
constexpr std::array<std::array<int, 2>, n_mass> mass_pairs{
    {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3}, {3, 3}}};

/// Lines at a smaller angle, left by round-off, have no crossing to follow.
constexpr double least_sine = 1e-14;

using Values = std::array<double, n_integrals>;
/// Two components a node, for each integral.
template<int n_nodes>
using Rows = std::array<std::array<double, 2 * n_nodes>, n_integrals>;

/// A point's shape functions on both faces.
struct PointShapes
{
  FlatShape own, other;
};

/// row += factor (x_0 v, x_1 v, ...) for a vector v of the plane.
template<std::size_t n, std::size_t m>
void add_product(std::array<double, n> &row, const std::array<double, m> &x, double v0, double v1)
{
  static_assert(n == 2 * m);
  for (std::size_t i = 0; i < m; ++i)
  {
    row[2 * i] += x[i] * v0;
    row[2 * i + 1] += x[i] * v1;
  }
}

/// Integrals over one triangle of area 1/2, and how they change while its points ride on its corners: the integrand at
/// a point that moves by dx changes by grad N . (dx - sum_m N_m dx_m), since sum_m N_m x_m = x.
class TriangleSums
{
public:
  void add_values(const PointShapes &at, double weight)
  {
    std::array<double, n_corners> weighted;
    for (int i = 0; i < n_corners; ++i)
      weighted[i] = weight * at.own.value[i];
    for (int r = 0; r < n_mass; ++r)
      value[r] += weighted[mass_pairs[r][0]] * at.own.value[mass_pairs[r][1]];
    for (int i = 0, r = n_mass; i < n_corners; ++i)
      for (int k = 0; k < n_corners; ++k, ++r)
        value[r] += weighted[i] * at.other.value[k];
  }

  void add_gradients(const PointShapes &at, const std::array<double, 3> &share, double weight)
  {
    const auto &n = at.own.value, &m = at.other.value;
    const auto &[nx, ny] = at.own.gradient;
    const auto &[mx, my] = at.other.gradient;
    for (int r = 0; r < n_mass; ++r)
    {
      const auto [i, k] = mass_pairs[r];
      const double x = weight * (n[i] * nx[k] + n[k] * nx[i]), y = weight * (n[i] * ny[k] + n[k] * ny[i]);
      add_product(by_corner[r], share, x, y);
      add_product(by_own[r], n, x, y);
    }
    for (int i = 0, r = n_mass; i < n_corners; ++i)
      for (int k = 0; k < n_corners; ++k, ++r)
      {
        const double own_x = weight * m[k] * nx[i], own_y = weight * m[k] * ny[i];
        const double other_x = weight * n[i] * mx[k], other_y = weight * n[i] * my[k];
        add_product(by_corner[r], share, own_x + other_x, own_y + other_y);
        add_product(by_own[r], n, own_x, own_y);
        add_product(by_other[r], m, other_x, other_y);
      }
  }

  Values value{};
  Rows<3> by_corner{};
  Rows<n_corners> by_own{}, by_other{}; ///< to be subtracted
};

/// How a corner moves that is the crossing of two lines: dx = sum over `nodes` of across (along . dx_node).
struct CornerMotion
{
  int n = 0;
  std::array<int, 4> nodes{};
  std::array<Vector2d, 4> across, along;

  void add(int node, const Vector2d &to, const Vector2d &by)
  {
    nodes[n] = node;
    across[n] = to;
    along[n++] = by;
  }
};

class Integration
{
public:
  Integration(const FlatFace &own, const FlatFace &other, const FlatPolygon &part, bool with_gradient,
              OverlapIntegrals &out)
    : own_(own)
    , other_(other)
    , part_(part)
    , with_gradient_(with_gradient)
    , out_(out)
  {
  }

  void run()
  {
    out_.size = out_.ring_size = part_.area();
    const int n = n_along_side(own_, other_, with_gradient_);
    for (int i = 2; i < part_.n; ++i)
      add_triangle(i, n);
    store_values();
    if (!with_gradient_)
      return;
    for (int corner = 0; corner < part_.n; ++corner)
      add_corner(corner);
    store_gradients();
  }

private:
  void add_triangle(int last, int n)
  {
    const FlatTriangle triangle = part_.triangle(last);
    TriangleSums sums;
    for (const TrianglePoint &point : triangle_rule(n))
    {
      const Vector2d x = triangle.at(point.share);
      const PointShapes at{own_.shape(x, with_gradient_), other_.shape(x, with_gradient_)};
      out_.least_gap = std::min(out_.least_gap, std::abs(other_.height_at(at.other) - own_.height_at(at.own)));
      sums.add_values(at, point.weight);
      if (with_gradient_)
        sums.add_gradients(at, point.share, point.weight);
    }
    for (int r = 0; r < n_integrals; ++r)
      values_[r] += triangle.twice_area * sums.value[r];
    if (with_gradient_)
      add_motions(triangle, {0, last - 1, last}, sums);
  }

  void add_motions(const FlatTriangle &triangle, const std::array<int, 3> &corners, const TriangleSums &sums)
  {
    for (int c = 0; c < 3; ++c)
    {
      // The area grows where a corner moves away from the opposite side.
      const Vector2d opposite = triangle.corner[(c + 2) % 3] - triangle.corner[(c + 1) % 3];
      for (int r = 0; r < n_integrals; ++r)
      {
        double *by = by_corner_[r].data() + 2 * static_cast<std::ptrdiff_t>(corners[c]);
        by[0] += triangle.twice_area * sums.by_corner[r][2 * c] - sums.value[r] * opposite.y();
        by[1] += triangle.twice_area * sums.by_corner[r][2 * c + 1] + sums.value[r] * opposite.x();
      }
    }
    for (int r = 0; r < n_integrals; ++r)
      for (int c = 0; c < 2 * n_corners; ++c)
      {
        by_node_[r][c] -= triangle.twice_area * sums.by_own[r][c];
        by_node_[r][2 * n_corners + c] -= triangle.twice_area * sums.by_other[r][c];
      }
  }

  [[nodiscard]] const Vector2d &node(int i) const { return i < n_corners ? own_.node(i) : other_.node(i - n_corners); }

  [[nodiscard]] CornerMotion motion(int corner) const
  {
    const FlatLine &before = part_.side[(corner + part_.n - 1) % part_.n], &after = part_.side[corner];
    CornerMotion out;
    if (before.to == after.from) // a node
    {
      out.add(before.to, Vector2d::UnitX(), Vector2d::UnitX());
      out.add(before.to, Vector2d::UnitY(), Vector2d::UnitY());
      return out;
    }
    const Vector2d first = node(before.to) - node(before.from), second = node(after.to) - node(after.from);
    // Along one line it goes as the other line moves.
    const double sine = first.x() * second.y() - first.y() * second.x();
    if (std::abs(sine) <= least_sine * first.norm() * second.norm())
      return out;
    add_line(before, first, second / sine, part_.corner[corner], out);
    add_line(after, second, -first / sine, part_.corner[corner], out);
    return out;
  }

  void add_line(const FlatLine &line, const Vector2d &way, const Vector2d &across, const Vector2d &x,
                CornerMotion &out) const
  {
    const double share = (x - node(line.from)).dot(way) / way.squaredNorm();
    const Vector2d normal(-way.y(), way.x());
    out.add(line.from, (1 - share) * across, normal);
    out.add(line.to, share * across, normal);
  }

  void add_corner(int corner)
  {
    const CornerMotion moves = motion(corner);
    for (int k = 0; k < moves.n; ++k)
      for (int r = 0; r < n_integrals; ++r)
      {
        const double *by = by_corner_[r].data() + 2 * static_cast<std::ptrdiff_t>(corner);
        const double change = by[0] * moves.across[k].x() + by[1] * moves.across[k].y();
        double *to = by_node_[r].data() + 2 * static_cast<std::ptrdiff_t>(moves.nodes[k]);
        to[0] += change * moves.along[k].x();
        to[1] += change * moves.along[k].y();
      }
  }

  void store_values()
  {
    for (int r = 0; r < n_mass; ++r)
    {
      const auto [i, k] = mass_pairs[r];
      out_.mass(i, k) = out_.mass(k, i) = values_[r];
    }
    for (int r = 0; r < n_mixed; ++r)
      out_.mixed(r / n_corners, r % n_corners) = values_[n_mass + r];
  }

  [[nodiscard]] double height(int i) const
  {
    const FlatFace &face = i < n_corners ? own_ : other_;
    return i % n_corners < face.n_nodes() ? face.height(i % n_corners) : 0;
  }

  void store_gradients()
  {
    for (int r = 0; r < n_integrals; ++r)
    {
      const auto [i, k] = r < n_mass ? mass_pairs[r] : std::array{(r - n_mass) / n_corners, (r - n_mass) % n_corners};
      auto &gradient = r < n_mass ? out_.mass_gradient : out_.mixed_gradient;
      auto to = gradient.row(4 * i + k);
      const auto &by = by_node_[r];
      for (int c = 0; c < 2 * n_corners; ++c)
      {
        to[c] = by[c];
        to[OverlapIntegrals::n_own + c] = by[2 * n_corners + c];
      }
      // As the plane's normal turns by dn, a node of height h moves by -h dn in it.
      for (int a = 0; a < 2 * n_corners; ++a)
        for (int c = 0; c < 2; ++c)
          to[2 * n_corners + c] -= height(a) * by[2 * a + c];
      if (r < n_mass)
        gradient.row(4 * k + i) = to;
    }
  }

  const FlatFace &own_, &other_;
  const FlatPolygon &part_;
  bool with_gradient_;
  OverlapIntegrals &out_;
  Values values_{};
  Rows<FlatPolygon::max_corners> by_corner_{};
  Rows<2 * n_corners> by_node_{};
};
} // namespace

void integrate_overlap(const ProjectionPlane &plane, const FaceCoordinates &target, bool with_gradient,
                       OverlapIntegrals &out)
{
  out.reset(with_gradient);
  if (!faces_each_other(plane.normal(), target))
    return;
  const FlatFace other = plane.flat(target);
  const FlatPolygon part = shared_part(plane.own(), other);
  if (part.n > 0)
    Integration(plane.own(), other, part, with_gradient, out).run();
}
} // namespace amontons
