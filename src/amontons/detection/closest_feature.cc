#include "amontons/detection/closest_feature.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
using Eigen::Vector3d;

// Local coordinates and lengths relative to the face nearer than this are the same: far above the round-off of
// coordinates, far below anything a mesh resolves.
constexpr double same = 1e-9;
// Cosine of the angle between the normals of faces that meet at a sharp edge.
constexpr double sharp_edge = 0.7;

// One face that meets at the closest point.
struct AttachedFace
{
  Index face = -1;
  FaceCoordinates x;
  LocalPoint xi{0, 0}; ///< of the closest point
  Vector3d normal;
  double angle = 1; ///< weight in the pseudonormal
  double signed_distance = 0;
};

LocalPoint vertex_coordinates(int n_nodes, int k)
{
  static constexpr LocalPoint corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  if (n_nodes == 3 && k == 2)
    return {0, 1};
  return corners[k];
}

int position_of(std::span<const Index> nodes, Index node)
{
  return static_cast<int>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

class FeatureView
{
public:
  FeatureView(const Target &target, const Candidate &candidate, const Vector3d &x, bool only_minima, Sight sight)
    : target_(target)
    , x_(x)
    , only_minima_(only_minima)
    , sight_(sight)
    , face_(candidate.face)
    , coordinates_(target.face(candidate.face))
    , point_(face_point(coordinates_, candidate.xi))
    , offset_(x - point_)
    , size_((coordinates_.x[1] - coordinates_.x[0]).norm())
  {
    feature_.pair.face = candidate.face;
    feature_.pair.xi = candidate.xi;
    feature_.pair.distance = std::sqrt(candidate.squared_distance);
  }

  Feature look(LocalPoint xi)
  {
    const FeatureOfFace where = feature_at(coordinates_.n_nodes, xi, same);
    if (where.type == FaceFeature::edge)
      look_at_edge(where.index, xi);
    else
      look_at_vertex(where.index);
    if (feature_.is_minimum || !only_minima_)
      choose(where.type);
    return feature_;
  }

private:
  void look_at_edge(int k, LocalPoint xi);
  void look_at_vertex(int k);
  void note_end(const AttachedFace &attached, int k, const Vector3d &inward);
  [[nodiscard]] bool is_minimum_at_vertex(Index node) const;
  [[nodiscard]] bool counts(Index face) const;
  void take(const AttachedFace &attached);
  void choose(FaceFeature type);

  const Target &target_;
  const Vector3d &x_;
  bool only_minima_;
  Sight sight_;
  Index face_;
  FaceCoordinates coordinates_;
  Vector3d point_, offset_;
  double size_;
  Feature feature_;

  Vector3d pseudonormal_{0, 0, 0};
  AttachedFace outer_, inner_; ///< best on either side
};

// In self-contact the target ends at sharp edges beyond which it is turned away: a node next to such an edge, flush
// with the side round it, came through the face that it sees, though it is nearer to the side.
bool FeatureView::counts(Index face) const
{
  if (!sight_.exclusions || !sight_.exclusions->is_turned_away(sight_.node, face))
    return true;
  const LocalPoint middle{0.3, 0.3};
  return face_normal(target_.face(face), middle).dot(face_normal(coordinates_, middle)) > sharp_edge;
}

// Direction in the face's tangent plane, across its edge (a, b), into the face.
Vector3d into_face(const Vector3d &a, const Vector3d &b, const Vector3d &normal)
{
  return normal.cross(b - a).normalized();
}

// Takes account of the end of the target that edge k (an end in 2D) may be.
void FeatureView::note_end(const AttachedFace &attached, int k, const Vector3d &inward)
{
  const double overhang = -offset_.dot(inward);
  const Index beyond = target_.neighbour(attached.face, k);
  if ((beyond >= 0 && counts(beyond)) || overhang < feature_.overhang || overhang <= same * size_)
    return;
  // Of ends that are passed by as much the longer face counts, in whatever order they are looked at.
  double extent = overhang == feature_.overhang ? feature_.extent : 0;
  for (int i = 0; i < attached.x.n_nodes; ++i)
    extent = std::max(extent, (attached.x.x[i] - point_).dot(inward));
  feature_.overhang = overhang;
  feature_.extent = extent;
}

// Whether a replaces b as the face of greatest signed distance.
bool better(const AttachedFace &a, const AttachedFace &b, double round_off, const Surface &surface)
{
  if (b.face < 0 || a.signed_distance > b.signed_distance + round_off)
    return true;
  return a.signed_distance >= b.signed_distance - round_off && surface.face_ids[a.face] < surface.face_ids[b.face];
}

void FeatureView::take(const AttachedFace &attached)
{
  pseudonormal_ += attached.angle * attached.normal;
  if (!sight_.sees(attached.face))
    return;
  const double round_off = same * size_;
  if (attached.signed_distance >= -round_off && better(attached, outer_, round_off, target_.surface()))
    outer_ = attached;
  if (attached.signed_distance <= round_off && better(attached, inner_, round_off, target_.surface()))
    inner_ = attached;
}

void FeatureView::look_at_edge(int k, LocalPoint xi)
{
  const auto nodes = target_.surface().face(face_);
  const Index a = nodes[k], b = nodes[(k + 1) % nodes.size()];
  const Vector3d xa = target_.node(a), xb = target_.node(b);
  const double along = (point_ - xa).dot(xb - xa) / (xb - xa).squaredNorm();
  for (const Index f : {face_, target_.neighbour(face_, k)})
  {
    if (f < 0 || !counts(f))
      continue;
    AttachedFace attached{f, target_.face(f), xi, Vector3d::Zero()};
    const auto own = target_.surface().face(f);
    const int i = position_of(own, a), j = position_of(own, b);
    const LocalPoint from = vertex_coordinates(attached.x.n_nodes, i), to = vertex_coordinates(attached.x.n_nodes, j);
    attached.xi = {from[0] + along * (to[0] - from[0]), from[1] + along * (to[1] - from[1])};
    attached.normal = face_normal(attached.x, attached.xi);
    attached.signed_distance = offset_.dot(attached.normal);
    take(attached);
    // The neighbour runs along the common edge the other way, if it is oriented alike.
    const int n = attached.x.n_nodes;
    const bool forward = (i + 1) % n == j;
    const Vector3d inward = into_face(attached.x.x[forward ? i : j], attached.x.x[forward ? j : i], attached.normal);
    if (offset_.dot(inward) > same * size_)
      feature_.is_minimum = false;
    if (only_minima_ && !feature_.is_minimum)
      return;
    note_end(attached, forward ? i : j, inward);
  }
}

// Along none of the edges that meet at the vertex does the target come closer, to first order.
bool FeatureView::is_minimum_at_vertex(Index node) const
{
  for (const Index f : target_.surface().faces_of_node(node))
  {
    if (!counts(f))
      continue;
    const auto own = target_.surface().face(f);
    const std::size_t n = own.size(), i = position_of(own, node);
    for (const Index other : {own[(i + 1) % n], own[(i + n - 1) % n]})
    {
      const Vector3d edge = target_.node(other) - point_;
      if (const double advance = offset_.dot(edge); advance > 0 && advance > same * size_ * edge.norm())
        return false;
    }
  }
  return true;
}

void FeatureView::look_at_vertex(int k)
{
  const Index node = target_.surface().face(face_)[k];
  feature_.is_minimum = is_minimum_at_vertex(node);
  if (only_minima_ && !feature_.is_minimum)
    return;
  for (const Index f : target_.surface().faces_of_node(node))
  {
    if (!counts(f))
      continue;
    AttachedFace attached{f, target_.face(f), {0, 0}, Vector3d::Zero()};
    const int n = attached.x.n_nodes, i = position_of(target_.surface().face(f), node);
    attached.xi = vertex_coordinates(n, i);
    attached.normal = face_normal(attached.x, attached.xi);
    attached.signed_distance = offset_.dot(attached.normal);
    const Vector3d &here = attached.x.x[i];
    const Vector3d ahead = (attached.x.x[(i + 1) % n] - here).normalized();
    if (n == 2)
    {
      note_end(attached, i, ahead);
      take(attached);
      continue;
    }
    const int before = (i + n - 1) % n;
    attached.angle = std::acos(std::clamp(ahead.dot((attached.x.x[before] - here).normalized()), -1.0, 1.0));
    take(attached);
    for (const int edge : {i, before})
      note_end(attached, edge, into_face(attached.x.x[edge], attached.x.x[(edge + 1) % n], attached.normal));
  }
}

void FeatureView::choose(FaceFeature type)
{
  feature_.inside = pseudonormal_.dot(offset_) < 0;
  const AttachedFace &chosen = (feature_.inside ? inner_.face >= 0 : outer_.face < 0) ? inner_ : outer_;
  const FaceProjection projection = project_on_face(chosen.x, x_, chosen.xi);
  Pair &pair = feature_.pair;
  pair.face = chosen.face;
  pair.xi = projection.xi;
  pair.gap = projection.gap;
  feature_.closest = chosen.xi;
  if (feature_.overhang > 0)
    pair.kind = PairKind::extension;
  else if (in_face(chosen.x.n_nodes, projection.xi, same))
    pair.kind = PairKind::face;
  else
    pair.kind = type == FaceFeature::edge ? PairKind::edge : PairKind::vertex;
}

// At a point inside a face.
Feature above_face(const Candidate &candidate)
{
  Feature feature;
  feature.closest = candidate.xi;
  feature.pair = {candidate.face, candidate.xi, candidate.gap, std::sqrt(candidate.squared_distance), PairKind::face};
  feature.inside = candidate.gap < 0;
  return feature;
}
} // namespace

bool is_inside_face(const Target &target, const Candidate &candidate)
{
  return feature_at(target.n_nodes_of_face(candidate.face), candidate.xi, same).type == FaceFeature::interior;
}

Feature look_at(const Target &target, const Candidate &candidate, const Vector3d &x, bool only_minima, Sight sight)
{
  if (is_inside_face(target, candidate))
    return above_face(candidate);
  return FeatureView(target, candidate, x, only_minima, sight).look(candidate.xi);
}
} // namespace amontons
