#include "amontons/contact/mortar.h"

#include "amontons/base/error.h"
#include "amontons/surface/normals.h"
#include "amontons/surface/segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace amontons
{
namespace
{
/// Edges of the impactor sharper than this stay sharp where its normals are averaged.
constexpr double sharp_angle = std::numbers::pi / 6;
/// Part of a node's share of a face that must be covered.
constexpr double least_share = 1e-6;
/// Part of a face by which overlaps may exceed it.
constexpr double overlap_tolerance = 1e-6;
/// Smaller weights are none.
constexpr double round_off = 1e-13;
constexpr int max_corners = 4;

using CornerVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_corners, 1>;
using CornerMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_corners, max_corners>;

/// One entry of M.
struct Entry
{
  Index impactor, target;
  double value;
};

/// Integrals over the covered part of one impactor face.
struct FaceIntegrals
{
  explicit FaceIntegrals(int n)
    : mass(CornerMatrix::Zero(n, n))
  {
  }
  double size = 0;                     ///< of that part, not of the ring
  CornerMatrix mass;                   ///< of N_i N_k
  std::map<Index, CornerVector> mixed; ///< of N_i N_k(target), by target node
  double weighted_size = 0;            ///< of the ring, where there is one
};

double size_of(const FaceCoordinates &face)
{
  if (face.n_nodes == 2)
    return (face.x[1] - face.x[0]).norm();
  const int last = face.n_nodes - 1;
  return 0.5 * (face.x[2] - face.x[0]).cross(face.x[last] - face.x[1]).norm();
}

/// Where a node of the face carries no multiplier: the node that stands in for it, else the node itself.
std::array<int, max_corners> representatives(const CornerVector &covered, double face_size)
{
  std::array<int, max_corners> out{};
  Eigen::Index best = 0;
  covered.maxCoeff(&best);
  const auto n = static_cast<int>(covered.size());
  for (int i = 0; i < n; ++i)
    out[i] = covered[i] >= least_share * face_size / n ? i : static_cast<int>(best);
  return out;
}

class Integration
{
public:
  Integration(const PlacedSurface &impactor, const PlacedSurface &target, bool axisymmetric, double w)
    : impactor_(impactor)
    , target_(target)
    , axisymmetric_(axisymmetric)
    , w_(w)
    , normals_(smoothed_normals(impactor.surface, impactor.x, sharp_angle))
  {
    const auto n = static_cast<std::size_t>(impactor.surface.n_nodes());
    out_.area.assign(n, 0);
    out_.normal.assign(n, Eigen::Vector3d::Zero());
  }

  MortarCoupling run(const FacesInBox &faces_in_box)
  {
    std::vector<Index> candidates;
    for (Index f = 0; f < impactor_.surface.n_faces(); ++f)
    {
      const FaceCoordinates face = gather_face(impactor_.surface.dim, impactor_.surface.face(f), impactor_.x);
      faces_in_box(reach_of(f, face), candidates);
      FaceIntegrals integrals(face.n_nodes);
      for (const Index t : candidates)
        add_overlap(f, face, t, integrals);
      if (integrals.size > (1 + overlap_tolerance) * size_of(face))
        out_.doubled_face = f;
      if (integrals.size > 0)
        add_face(f, size_of(face), integrals);
    }
    finish();
    return std::move(out_);
  }

private:
  [[nodiscard]] Eigen::Vector3d normal(Index f, int corner) const
  {
    const int dim = impactor_.surface.dim;
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    const auto at = static_cast<std::size_t>(impactor_.surface.face_offsets[f] + corner) * dim;
    std::copy_n(normals_.begin() + static_cast<std::ptrdiff_t>(at), dim, out.data());
    return out;
  }

  /// All points within w of the face along the normals that it is projected by.
  [[nodiscard]] Eigen::AlignedBox3d reach_of(Index f, const FaceCoordinates &face) const
  {
    Eigen::AlignedBox3d out;
    const int dim = impactor_.surface.dim;
    const Eigen::Vector3d middle = dim == 3 ? face_normal(face, face_centre(face)) : Eigen::Vector3d::Zero();
    // Between two ends the interpolated normals are shorter than one: of length one they reach farther.
    const double shortest = dim == 2 ? 0.5 * (normal(f, 0) + normal(f, 1)).norm() : 1;
    for (int i = 0; i < face.n_nodes; ++i)
    {
      const Eigen::Vector3d way = w_ / shortest * (dim == 2 ? normal(f, i) : middle);
      out.extend(face.x[i] + way);
      out.extend(face.x[i] - way);
    }
    return out;
  }

  void add_overlap(Index f, const FaceCoordinates &face, Index t, FaceIntegrals &integrals)
  {
    const auto nodes = target_.surface.face(t);
    const FaceCoordinates other = gather_face(target_.surface.dim, nodes, target_.x);
    const FaceOverlap overlap = impactor_.surface.dim == 2
                                    ? overlap_of_segments(face, {normal(f, 0), normal(f, 1)}, other)
                                    : overlap_of_faces(face, other);
    double least_gap = std::numeric_limits<double>::infinity();
    for (const OverlapPoint &point : overlap.points)
      least_gap = std::min(least_gap, std::abs(point.gap));
    if (!(least_gap <= w_))
      return;
    ++out_.n_overlaps;
    integrals.size += overlap.size;
    for (const OverlapPoint &point : overlap.points)
    {
      const double ring = axisymmetric_ ? 2 * std::numbers::pi * face_point(face, point.impactor).x() : 1;
      const auto own = shape_functions(face.n_nodes, point.impactor),
                 others = shape_functions(other.n_nodes, point.target);
      const Eigen::Map<const CornerVector> values(own.data(), face.n_nodes);
      integrals.weighted_size += ring * point.weight;
      integrals.mass += ring * point.weight * values * values.transpose();
      for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        const auto place = integrals.mixed.try_emplace(nodes[k], CornerVector::Zero(face.n_nodes)).first;
        place->second += ring * point.weight * others[k] * values;
      }
    }
  }

  /// With R the representatives (N' = R N), D = diag(R mass 1) and Phi = D (R mass R^T)^-1 N'.
  void add_face(Index f, double face_size, const FaceIntegrals &integrals)
  {
    const auto nodes = impactor_.surface.face(f);
    const auto n = static_cast<Eigen::Index>(nodes.size());
    const CornerVector covered = integrals.mass.rowwise().sum();
    const auto stands_for = representatives(covered, face_size * integrals.weighted_size / integrals.size);
    std::vector<int> kept;
    for (int i = 0; i < n; ++i)
      if (stands_for[i] == i)
        kept.push_back(i);
    CornerMatrix merge = CornerMatrix::Zero(static_cast<Eigen::Index>(kept.size()), n);
    for (std::size_t k = 0; k < kept.size(); ++k)
      for (int i = 0; i < n; ++i)
        merge(static_cast<Eigen::Index>(k), i) = stands_for[i] == kept[k] ? 1 : 0;
    const CornerVector own = merge * covered;
    const auto inverse = CornerMatrix(merge * integrals.mass * merge.transpose()).ldlt();
    for (std::size_t k = 0; k < kept.size(); ++k)
    {
      out_.area[nodes[kept[k]]] += own[static_cast<Eigen::Index>(k)];
      out_.normal[nodes[kept[k]]] -= own[static_cast<Eigen::Index>(k)] * normal(f, kept[k]);
    }
    for (const auto &[target, mixed] : integrals.mixed)
    {
      const CornerVector row = own.cwiseProduct(CornerVector(inverse.solve(CornerVector(merge * mixed))));
      for (std::size_t k = 0; k < kept.size(); ++k)
        entries_.push_back({nodes[kept[k]], target, row[static_cast<Eigen::Index>(k)]});
    }
  }

  void finish()
  {
    std::sort(entries_.begin(), entries_.end(),
              [](const Entry &a, const Entry &b)
              { return std::pair(a.impactor, a.target) < std::pair(b.impactor, b.target); });
    std::size_t next = 0;
    for (Index j = 0; j < impactor_.surface.n_nodes(); ++j)
    {
      out_.offsets.push_back(static_cast<Index>(out_.targets.size()));
      if (out_.area[j] > 0)
        out_.normal[j].normalize();
      while (next < entries_.size() && entries_[next].impactor == j)
      {
        const Index target = entries_[next].target;
        double sum = 0;
        for (; next < entries_.size() && entries_[next].impactor == j && entries_[next].target == target; ++next)
          sum += entries_[next].value;
        if (std::abs(sum) <= round_off * out_.area[j])
          continue;
        out_.targets.push_back(target);
        out_.weight.push_back(sum / out_.area[j]);
      }
    }
    out_.offsets.push_back(static_cast<Index>(out_.targets.size()));
  }

  const PlacedSurface impactor_, target_;
  bool axisymmetric_;
  double w_;
  std::vector<double> normals_; ///< at the corners of the impactor's faces
  std::vector<Entry> entries_;
  MortarCoupling out_;
};
} // namespace

MortarCoupling couple_mortar(const PlacedSurface &impactor, const PlacedSurface &target, bool axisymmetric, double w,
                             const FacesInBox &faces_in_box, const MortarScope &scope)
{
  if (scope.gradients || !scope.nodes.empty())
    throw InternalError("a coupling of some nodes, or with gradients, is not there yet");
  return Integration(impactor, target, axisymmetric, w).run(faces_in_box);
}
} // namespace amontons
