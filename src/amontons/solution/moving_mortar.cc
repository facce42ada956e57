#include "amontons/solution/moving_mortar.h"

#include "amontons/base/error.h"
#include "amontons/contact/kinematics.h"
#include "amontons/detection/face_boxes.h"
#include "amontons/surface/projection.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// Diagonals of a face that the distance is at least, so that what a node in contact sees of steep sides is all there.
constexpr double least_reach = 3;

Index place_in(const std::vector<Index> &nodes, Index node)
{
  return static_cast<Index>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

void add_missing(std::vector<Index> &nodes, std::span<const Index> more)
{
  for (const Index node : more)
    if (std::find(nodes.begin(), nodes.end(), node) == nodes.end())
      nodes.push_back(node);
}

/// Node j and, in space, its neighbours on the first of its faces, from the next to the last: between these e_1 points.
/// An edge may stand on the node's mean normal where faces of two sides meet; this diagonal does not.
std::vector<Index> first_impactors(const Surface &surface, Index j)
{
  if (surface.dim == 2)
    return {j};
  const auto face = surface.face(surface.faces_of_node(j).front());
  const auto n = face.size(), here = static_cast<std::size_t>(std::find(face.begin(), face.end(), j) - face.begin());
  return {j, face[(here + 1) % n], face[(here + n - 1) % n]};
}

double longest_diagonal(const Surface &surface)
{
  double out = 0;
  for (Index f = 0; f < surface.n_faces(); ++f)
  {
    const FaceCoordinates face = gather_face(surface.dim, surface.face(f), surface.reference);
    for (int i = 1; i < face.n_nodes; ++i)
      out = std::max(out, (face.x[i] - face.x[0]).norm());
  }
  return out;
}

/// (1 - fraction) a + fraction b
std::vector<std::pair<Index, double>> between(const std::vector<std::pair<Index, double>> &a,
                                              const std::vector<std::pair<Index, double>> &b, double fraction)
{
  std::vector<std::pair<Index, double>> out;
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() || j != b.end())
  {
    const bool from_a = j == b.end() || (i != a.end() && i->first <= j->first);
    const bool from_b = i == a.end() || (j != b.end() && j->first <= i->first);
    out.emplace_back(from_a ? i->first : j->first,
                     (from_a ? (1 - fraction) * i->second : 0) + (from_b ? fraction * j->second : 0));
    i += from_a ? 1 : 0;
    j += from_b ? 1 : 0;
  }
  return out;
}
} // namespace

MovingMortar::MovingMortar(std::shared_ptr<const Surface> impactor, std::shared_ptr<const Surface> target,
                           bool axisymmetric, std::span<const GlobalIndex> own, std::optional<double> own_distance)
  : impactor_(std::move(impactor))
  , target_(std::move(target))
  , axisymmetric_(axisymmetric)
  , is_own_(static_cast<std::size_t>(impactor_->n_nodes()), 0)
  , own_distance_(own_distance)
  , least_distance_(least_reach * longest_diagonal(*impactor_))
  , nodes_(own.size())
  , start_(own.size())
  , origin_(own.size())
{
  for (const GlobalIndex id : own)
  {
    const auto place = std::lower_bound(impactor_->node_ids.begin(), impactor_->node_ids.end(), id);
    own_.push_back(static_cast<Index>(place - impactor_->node_ids.begin()));
    is_own_[own_.back()] = 1;
  }
  set_reach(0);
}

std::vector<GlobalIndex> MovingMortar::wanted_nodes() const
{
  std::vector<GlobalIndex> out(impactor_->node_ids.begin(), impactor_->node_ids.end());
  out.insert(out.end(), target_->node_ids.begin(), target_->node_ids.end());
  return out;
}

void MovingMortar::place(const std::function<Index(GlobalIndex)> &position_of)
{
  const auto place = [&](const Surface &surface, std::vector<Index> &positions)
  {
    positions.clear();
    for (const GlobalIndex id : surface.node_ids)
      positions.push_back(position_of(id));
  };
  place(*impactor_, impactor_positions_);
  place(*target_, target_positions_);
}

void MovingMortar::set_least_distance(double distance)
{
  least_distance_ = std::max(least_distance_, distance);
}

void MovingMortar::set_reach(double reach)
{
  const double distance = own_distance_.value_or(std::max(reach, least_distance_));
  if (distance != distance_)
    impactor_x_.clear();
  distance_ = distance;
}

std::vector<double> MovingMortar::places(const Surface &surface, const std::vector<Index> &positions,
                                         std::span<const double> displacement) const
{
  std::vector<double> x(surface.reference);
  for (Index i = 0; i < surface.n_nodes(); ++i)
    for (int c = 0; c < surface.dim; ++c)
      x[i * surface.dim + c] += displacement[static_cast<std::size_t>(positions[i]) * surface.dim + c];
  return x;
}

void MovingMortar::move_to(std::span<const double> displacement)
{
  std::vector<double> impactor_x = places(*impactor_, impactor_positions_, displacement);
  std::vector<double> target_x = places(*target_, target_positions_, displacement);
  if (impactor_x == impactor_x_ && target_x == target_x_)
    return;
  const FaceBoxes boxes(*target_, target_x);
  coupling_ = couple_mortar(
      {*impactor_, impactor_x}, {*target_, target_x}, axisymmetric_, distance_,
      [&](const Eigen::AlignedBox3d &box, std::vector<Index> &faces) { boxes.meeting(box, faces); }, {is_own_, true});
  impactor_x_ = std::move(impactor_x);
  target_x_ = std::move(target_x);
}

MovingMortar::Nodes MovingMortar::with_needed(Nodes nodes, Index i) const
{
  const Index j = own_[i];
  if (nodes.impactors.empty())
    nodes.impactors = first_impactors(*impactor_, j);
  if (coupling_.sees_target(j))
  {
    add_missing(nodes.impactors, coupling_.gradients.impactors_of(j));
    add_missing(nodes.targets, coupling_.targets_of(j));
  }
  for (const auto &[node, weight] : origin_[i])
    add_missing(nodes.targets, {&node, 1});
  return nodes;
}

bool MovingMortar::take_nodes(bool forget)
{
  bool changed = false;
  for (std::size_t i = 0; i < own_.size(); ++i)
  {
    Nodes taken = with_needed(forget ? Nodes{} : nodes_[i], static_cast<Index>(i));
    changed |= taken != nodes_[i];
    nodes_[i] = std::move(taken);
  }
  return changed;
}

std::vector<Index> MovingMortar::nodes(Index i) const
{
  std::vector<Index> out{impactor_positions_[own_[i]]};
  if (nodes_[i].targets.empty())
    return out;
  for (std::size_t k = 1; k < nodes_[i].impactors.size(); ++k)
    out.push_back(impactor_positions_[nodes_[i].impactors[k]]);
  for (const Index node : nodes_[i].targets)
    out.push_back(target_positions_[node]);
  return out;
}

MovingMortar::Mean MovingMortar::mean(Index i) const
{
  Mean out;
  const auto targets = coupling_.targets_of(own_[i]);
  const auto weights = coupling_.weights_of(own_[i]);
  for (std::size_t k = 0; k < targets.size(); ++k)
    out.emplace_back(targets[k], weights[k]);
  return out;
}

double MovingMortar::gap(Index i) const
{
  const Index j = own_[i];
  const int dim = impactor_->dim;
  const auto targets = coupling_.targets_of(j);
  const auto weights = coupling_.weights_of(j);
  double out = 0;
  for (int c = 0; c < dim; ++c)
  {
    double relative = impactor_x_[j * dim + c];
    for (std::size_t k = 0; k < targets.size(); ++k)
      relative -= weights[k] * target_x_[targets[k] * dim + c];
    out += coupling_.normal[j][c] * relative;
  }
  return out;
}

std::vector<double> MovingMortar::covered_shares() const
{
  Surface moved = *impactor_;
  moved.reference = impactor_x_;
  const std::vector<double> whole = tributary_areas(moved, axisymmetric_);
  std::vector<double> out;
  for (const Index j : own_)
    out.push_back(std::min(1.0, coupling_.area[j] / whole[j]));
  return out;
}

ContactLinearisation MovingMortar::linearise(Index i) const
{
  const int dim = impactor_->dim;
  const Index j = own_[i];
  const Nodes nodes = with_needed(nodes_[i], i);
  const auto impactors = coupling_.gradients.impactors_of(j);
  const auto targets = coupling_.targets_of(j);
  const auto weights = coupling_.weights_of(j);
  const auto n_impactors = static_cast<Eigen::Index>(nodes.impactors.size());
  const auto n_targets = static_cast<Eigen::Index>(nodes.targets.size());

  std::vector<double> impactor_x, target_x, weight(nodes.targets.size(), 0.0), origin(weight);
  for (const Index node : nodes.impactors)
    impactor_x.insert(impactor_x.end(), &impactor_x_[node * dim], &impactor_x_[node * dim] + dim);
  for (const Index node : nodes.targets)
    target_x.insert(target_x.end(), &target_x_[node * dim], &target_x_[node * dim] + dim);

  // Columns of the coupling's gradients among the element's.
  std::vector<Eigen::Index> column;
  for (const Index node : impactors)
    column.push_back(dim * place_in(nodes.impactors, node));
  std::vector<Index> row;
  for (const Index node : targets)
  {
    row.push_back(place_in(nodes.targets, node));
    column.push_back(dim * (n_impactors + row.back()));
  }
  Eigen::MatrixXd normal_gradient = Eigen::MatrixXd::Zero(dim, dim * n_impactors);
  Eigen::MatrixXd weight_gradient = Eigen::MatrixXd::Zero(n_targets, dim * (n_impactors + n_targets));
  const Eigen::MatrixXd &own_normal = coupling_.gradients.normal[j], &own_weight = coupling_.gradients.weight[j];
  for (std::size_t k = 0; k < column.size(); ++k)
  {
    const auto from = static_cast<Eigen::Index>(dim * k);
    if (k < impactors.size())
      normal_gradient.middleCols(column[k], dim) = own_normal.middleCols(from, dim);
    for (std::size_t t = 0; t < row.size(); ++t)
      weight_gradient.block(row[t], column[k], 1, dim) = own_weight.block(static_cast<Eigen::Index>(t), from, 1, dim);
  }
  for (std::size_t t = 0; t < row.size(); ++t)
    weight[row[t]] = weights[t];
  if (origin_[i].empty())
    origin = weight;
  for (const auto &[node, value] : origin_[i])
    origin[place_in(nodes.targets, node)] = value;
  return linearise_mortar(dim, coupling_.normal[j], normal_gradient, impactor_x, target_x, weight, weight_gradient,
                          origin, {1, 2});
}

void MovingMortar::begin_increment()
{
  for (std::size_t i = 0; i < own_.size(); ++i)
  {
    start_[i] = sees_target(static_cast<Index>(i)) ? mean(static_cast<Index>(i)) : Mean();
    origin_[i] = start_[i];
  }
}

void MovingMortar::set_origin(Index i, double fraction)
{
  if (!sees_target(i))
    return;
  origin_[i] = start_[i].empty() ? mean(i) : between(start_[i], mean(i), fraction);
}
} // namespace amontons
