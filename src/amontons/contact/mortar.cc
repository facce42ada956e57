#include "amontons/contact/mortar.h"

#include "amontons/base/error.h"
#include "amontons/contact/mortar_gradients.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace amontons
{
namespace
{
/// Part of a face by which overlaps may exceed it.
constexpr double overlap_tolerance = 1e-6;
/// Part of the best face's facing below which a face beyond a sharp edge does not count at a node.
constexpr double least_facing = 0.5;
/// Cosine between normals at a node from which on there is a sharp edge.
constexpr double sharp_cosine = 0.86602540378443865;
/// Smaller weights are none.
constexpr double round_off = 1e-13;

/// One entry of M.
struct Entry
{
  Index impactor, target;
  double value;
};

double size_of(const FaceCoordinates &face)
{
  if (face.n_nodes == 2)
    return (face.x[1] - face.x[0]).norm();
  const int last = face.n_nodes - 1;
  return 0.5 * (face.x[2] - face.x[0]).cross(face.x[last] - face.x[1]).norm();
}

class Coupling
{
public:
  Coupling(const PlacedSurface &impactor, const PlacedSurface &target, bool axisymmetric, double w,
           const MortarScope &scope)
    : impactor_(impactor)
    , target_(target)
    , axisymmetric_(axisymmetric)
    , w_(w)
    , scope_(scope)
    , normals_(impactor)
  {
    const auto n = static_cast<std::size_t>(impactor.surface.n_nodes());
    out_.area.assign(n, 0);
    out_.normal.assign(n, Eigen::Vector3d::Zero());
    if (scope.gradients)
      gradients_.emplace(impactor, normals_);
  }

  MortarCoupling run(const FacesInBox &faces_in_box)
  {
    std::vector<Index> candidates;
    for (Index f = 0; f < impactor_.surface.n_faces(); ++f)
    {
      const auto nodes = impactor_.surface.face(f);
      if (std::none_of(nodes.begin(), nodes.end(), [&](Index node) { return wanted(node); }))
        continue;
      const FaceCoordinates face = gather_face(impactor_.surface.dim, nodes, impactor_.x);
      faces_in_box(reach_of(f, face), candidates);
      look(f, face, candidates);
      keep_nearest_layer(size_of(face));
      out_.n_overlaps += static_cast<Index>(n_seen_);
      if (n_seen_ > 0)
        coupled_.push_back({f, couple_face(face.n_nodes, size_of(face), seen_faces(), scope_.gradients)});
    }
    leave_out_aslant();
    for (auto &[f, face] : coupled_)
      add_face(f, std::move(face));
    finish();
    return std::move(out_);
  }

private:
  [[nodiscard]] bool wanted(Index node) const { return scope_.nodes.empty() || scope_.nodes[node] != 0; }
  [[nodiscard]] std::span<const SeenFace> seen_faces() const { return {seen_.data(), n_seen_}; }

  /// All points within w of the face along the normals that it is projected by.
  [[nodiscard]] Eigen::AlignedBox3d reach_of(Index f, const FaceCoordinates &face) const
  {
    Eigen::AlignedBox3d out;
    const int dim = impactor_.surface.dim;
    const Eigen::Vector3d middle = dim == 3 ? face_normal(face, face_centre(face)) : Eigen::Vector3d::Zero();
    // Between two ends the interpolated normals are shorter than one: of length one they reach farther.
    const double shortest = dim == 2 ? 0.5 * (normals_.at(f, 0) + normals_.at(f, 1)).norm() : 1;
    for (int i = 0; i < face.n_nodes; ++i)
    {
      const Eigen::Vector3d way = w_ / shortest * (dim == 2 ? normals_.at(f, i) : middle);
      out.extend(face.x[i] + way);
      out.extend(face.x[i] - way);
    }
    return out;
  }

  /// Finds the faces seen.
  void look(Index f, const FaceCoordinates &face, const std::vector<Index> &candidates)
  {
    n_seen_ = 0;
    const int dim = impactor_.surface.dim;
    const Eigen::Vector3d normal = face_normal(face, face_centre(face));
    std::optional<ProjectionPlane> plane;
    if (dim == 3)
      plane.emplace(face);
    for (const Index t : candidates)
    {
      const auto nodes = target_.surface.face(t);
      const FaceCoordinates other = gather_face(dim, nodes, target_.x);
      if (n_seen_ == seen_.size())
        seen_.emplace_back();
      seen_[n_seen_].nodes = nodes;
      OverlapIntegrals &integrals = seen_[n_seen_].integrals;
      if (dim == 3)
        integrate_overlap(*plane, other, scope_.gradients, integrals);
      else
        integrate_overlap(face, {normals_.at(f, 0), normals_.at(f, 1)}, other, axisymmetric_, scope_.gradients,
                          integrals);
      seen_[n_seen_].facing = -normal.dot(face_normal(other, face_centre(other)));
      if (integrals.least_gap <= w_)
        ++n_seen_;
    }
  }

  /// Where more is seen than the face is large, the farthest go until it is not.
  void keep_nearest_layer(double face_size)
  {
    double seen = 0;
    for (const SeenFace &other : seen_faces())
      seen += other.integrals.size;
    while (seen > (1 + overlap_tolerance) * face_size)
    {
      const auto end = seen_.begin() + static_cast<std::ptrdiff_t>(n_seen_);
      const auto farthest = std::max_element(seen_.begin(), end,
                                             [](const SeenFace &a, const SeenFace &b)
                                             { return a.integrals.least_gap < b.integrals.least_gap; });
      seen -= farthest->integrals.size;
      std::rotate(farthest, farthest + 1, end);
      --n_seen_;
    }
  }

  /// Where faces beyond sharp edges round a node see the target aslant, next to one that sees it well.
  void leave_out_aslant()
  {
    struct Best
    {
      double facing = 0;
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    };
    std::vector<Best> best(out_.area.size());
    const auto visit = [&](const auto &with)
    {
      for (auto &[f, face] : coupled_)
        for (int &corner : face.corners)
          with(face.facing, normals_.at(f, corner), best[impactor_.surface.face(f)[corner]], corner);
    };
    visit(
        [](double facing, const Eigen::Vector3d &normal, Best &at, int &)
        {
          if (facing > at.facing)
            at = {facing, normal};
        });
    visit(
        [](double facing, const Eigen::Vector3d &normal, const Best &at, int &corner)
        {
          if (facing < least_facing * at.facing && normal.dot(at.normal) < sharp_cosine)
            corner = -1;
        });
  }

  void add_face(Index f, FaceCoupling face)
  {
    const auto nodes = impactor_.surface.face(f);
    for (std::size_t k = 0; k < face.corners.size(); ++k)
    {
      const auto row = static_cast<Eigen::Index>(k);
      if (face.corners[k] < 0 || !wanted(nodes[face.corners[k]]))
        continue;
      const Index node = nodes[face.corners[k]];
      out_.area[node] += face.own[row];
      out_.normal[node] -= face.own[row] * normals_.at(f, face.corners[k]);
      for (std::size_t t = 0; t < face.targets.size(); ++t)
        entries_.push_back({node, face.targets[t], face.mortar(row, static_cast<Eigen::Index>(t))});
    }
    if (gradients_)
      gradients_->add(f, std::move(face));
  }

  void finish()
  {
    // Equal ones stay in the order of the faces, so that their sum depends on nothing else.
    std::stable_sort(entries_.begin(), entries_.end(),
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
        // A weight that vanishes may yet change.
        if (!gradients_ && std::abs(sum) <= round_off * out_.area[j])
          continue;
        out_.targets.push_back(target);
        out_.weight.push_back(sum / out_.area[j]);
      }
    }
    out_.offsets.push_back(static_cast<Index>(out_.targets.size()));
    if (gradients_)
      out_.gradients = gradients_->gather(out_);
  }

  const PlacedSurface impactor_, target_;
  bool axisymmetric_;
  double w_;
  MortarScope scope_;
  MortarNormals normals_;
  std::vector<SeenFace> seen_; ///< by one face, of which the first n_seen_ are in use
  std::size_t n_seen_ = 0;
  std::vector<std::pair<Index, FaceCoupling>> coupled_; ///< faces that see something
  std::vector<Entry> entries_;
  std::optional<MortarGradientAssembly> gradients_;
  MortarCoupling out_;
};
} // namespace

MortarCoupling couple_mortar(const PlacedSurface &impactor, const PlacedSurface &target, bool axisymmetric, double w,
                             const FacesInBox &faces_in_box, const MortarScope &scope)
{
  AMONTONS_ASSERT(scope.nodes.empty() || scope.nodes.size() == impactor.surface.node_ids.size());
  return Coupling(impactor, target, axisymmetric, w, scope).run(faces_in_box);
}
} // namespace amontons
