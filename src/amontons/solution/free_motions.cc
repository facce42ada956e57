#include "amontons/solution/free_motions.h"

#include "amontons/parallel/agreement.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace amontons
{
namespace
{
/// Eigenvalues of the restraints' Gram matrix below this share of the largest belong to free motions.
constexpr double free_share = 1e-11;
constexpr double load_share = 1e-10;
/// A gap that closes more slowly, over the motion, does not stop it.
constexpr double least_approach = 1e-6;

Eigen::MatrixXd null_space(const Eigen::MatrixXd &gram)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const double limit = free_share * std::max(eigen.eigenvalues().maxCoeff(), 1.0);
  Eigen::Index n = 0;
  while (n < gram.rows() && eigen.eigenvalues()[n] < limit)
    ++n;
  return eigen.eigenvectors().leftCols(n);
}

void sum_up(const Sharing &processes, Eigen::MatrixXd &matrix)
{
  processes.sum_over_processes({matrix.data(), static_cast<std::size_t>(matrix.size())});
}
} // namespace

FreeMotions::FreeMotions(const Model &model)
  : model_(model)
  , halo_version_(model.halo_version())
{
  find_parts();
  make_modes();
  support_gram_ =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(modes_.size()), static_cast<Eigen::Index>(modes_.size()));
  if (modes_.empty())
    return;
  add_supports({}, support_gram_);
  sum_up(model_.nodes(), support_gram_);
  any_ = null_space(support_gram_).cols() > 0;
}

void FreeMotions::make_modes()
{
  const int dim = model_.dim();
  const bool axisymmetric = model_.options().mesh.kinematics == Kinematics::axisymmetric;
  for (int part = 0; part < static_cast<int>(body_of_part_.size()); ++part)
  {
    const int rigid = model_.rigid().of_option(body_of_part_[part]);
    const auto moves = [&](bool rotation, int axis)
    {
      if (rigid < 0)
        return true;
      const RigidBody &body = model_.rigid().bodies()[rigid];
      return (rotation ? body.rotation : body.translation)[axis].kind == RigidComponent::Kind::free;
    };
    for (int axis = axisymmetric ? 1 : 0; axis < dim; ++axis)
      if (moves(false, axis))
        modes_.push_back({part, axis, false});
    if (axisymmetric)
      continue;
    for (int axis = dim == 2 ? 2 : 0; axis < 3; ++axis)
      if (moves(true, axis))
        modes_.push_back({part, axis, true});
  }
}

/// Nodes that came to the halo belong to what their owners say.
void FreeMotions::follow_halo()
{
  if (std::exchange(halo_version_, model_.halo_version()) == model_.halo_version())
    return;
  std::vector<double> parts(part_of_node_.begin(), part_of_node_.begin() + model_.n_state_nodes());
  parts.resize(model_.node_ids().size(), -1);
  model_.nodes().take_owners(parts);
  part_of_node_.assign(parts.begin(), parts.end());
}

Eigen::Vector3d FreeMotions::place(Displacement displacement, Index node) const
{
  Eigen::Vector3d x = model_.reference(node);
  if (!model_.small_strain() && !displacement.empty())
    for (int c = 0; c < model_.dim(); ++c)
      x[c] += displacement[static_cast<std::size_t>(node) * model_.dim() + c];
  return x;
}

Eigen::Vector3d FreeMotions::velocity(const Mode &mode, const Carrier &carrier, const Eigen::Vector3d &at) const
{
  if (carrier.part != mode.component)
    return Eigen::Vector3d::Zero();
  if (!mode.rotation)
    return Eigen::Vector3d::Unit(mode.axis);
  return Eigen::Vector3d::Unit(mode.axis).cross(at - center_[mode.component]) / size_[mode.component];
}

Eigen::VectorXd FreeMotions::over_modes(Displacement displacement, int contact, Index node,
                                        const ContactVector &row) const
{
  const int dim = model_.dim();
  const std::vector<Index> nodes = model_.contacts()[contact].nodes(node);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(modes_.size()));
  for (std::size_t k = 0; k < nodes.size(); ++k)
  {
    const Eigen::Vector3d at = place(displacement, nodes[k]);
    for (std::size_t m = 0; m < modes_.size(); ++m)
    {
      const Eigen::Vector3d v = velocity(modes_[m], carrier(nodes[k]), at);
      for (int c = 0; c < dim; ++c)
        out[static_cast<Eigen::Index>(m)] += row[static_cast<Eigen::Index>(k) * dim + c] * v[c];
    }
  }
  return out;
}

void FreeMotions::add_supports(Displacement displacement, Eigen::MatrixXd &gram) const
{
  const int dim = model_.dim();
  const auto hold = [&](Index node, int component)
  {
    const Eigen::Vector3d at = place(displacement, node);
    Eigen::VectorXd row(gram.rows());
    for (Eigen::Index m = 0; m < row.size(); ++m)
      row[m] = velocity(modes_[m], carrier(node), at)[component];
    gram += row * row.transpose();
  };
  for (const HeldComponent &held : model_.supports().held())
    if (model_.nodes().is_own(held.nodal / dim))
      hold(held.nodal / dim, held.nodal % dim);
  // Nodes shared with a rigid body that does not move.
  const auto &rigid_of_node = model_.rigid_of_node();
  for (Index node = 0; node < model_.mesh().n_nodes(); ++node)
    if (const int b = rigid_of_node[node]; b >= 0 && model_.nodes().is_own(node) && part_of_node_[node] >= 0 &&
                                           body_of_part_[part_of_node_[node]] != model_.rigid().bodies()[b].option)
      for (int c = 0; c < dim; ++c)
        hold(node, c);
  for (const BoundaryOptions &entry : model_.options().boundary)
    if (!entry.spring.empty() && !model_.rigid().concerns(entry))
      for (const Index node : boundary_group(model_.mesh(), model_.options().bodies, entry).entities.nodes)
        for (const auto &spring : entry.spring)
          hold(node, spring.first);
}

void FreeMotions::check_restrained() const
{
  if (!any_)
    return;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(support_gram_.rows(), support_gram_.cols());
  for (const ContactInterface &contact : model_.contacts())
  {
    // Whichever face a node will meet: it sticks to the target as to one body.
    const Carrier target = carrier_of_target(contact);
    for (Index i = 0; i < contact.n_nodes(); ++i)
    {
      const Eigen::Vector3d at = model_.reference(contact.node(i));
      for (int c = 0; c < model_.dim(); ++c)
      {
        Eigen::VectorXd row(gram.rows());
        for (Eigen::Index m = 0; m < row.size(); ++m)
          row[m] = velocity(modes_[m], carrier(contact.node(i)), at)[c] - velocity(modes_[m], target, at)[c];
        gram += row * row.transpose();
      }
    }
  }
  sum_up(model_.nodes(), gram);
  gram += support_gram_;
  const Eigen::MatrixXd free = null_space(gram);
  if (free.cols() == 0)
    return;
  Eigen::Index mode = 0;
  free.col(0).cwiseAbs().maxCoeff(&mode);
  const BodyOptions &body = model_.options().bodies[body_of_part_[modes_[mode].component]];
  throw UserError(body.where, "body '" + body.name + "' can move freely (" + describe(free.col(0)) +
                                  "): neither a support nor any of its contacts holds it");
}

FreeMotions::Carrier FreeMotions::carrier_of_target(const ContactInterface &contact) const
{
  const Sharing &nodes = model_.nodes();
  const std::vector<Index> &targets = contact.target_nodes();
  const auto lowest = std::min_element(targets.begin(), targets.end(),
                                       [&](Index a, Index b) { return model_.node_id(a) < model_.node_id(b); });
  const Index node = lowest == targets.end() ? -1 : *lowest;
  std::array<double, 2> told{-1, -1};
  if (is_greatest(nodes, node < 0 ? no_candidate : -static_cast<double>(model_.node_id(node)), nodes.rank()))
    told = {static_cast<double>(carrier(node).part), static_cast<double>(carrier(node).rigid)};
  nodes.maximum_over_processes(told);
  return {static_cast<int>(told[0]), static_cast<int>(told[1])};
}

std::string FreeMotions::describe(const Eigen::VectorXd &motion) const
{
  Eigen::Index m = 0;
  motion.cwiseAbs().maxCoeff(&m);
  return std::string(modes_[m].rotation ? "rotation about " : "translation along ") + "xyz"[modes_[m].axis];
}

Eigen::VectorXd FreeMotions::loads(Displacement displacement, std::span<const double> residual, double time) const
{
  const int dim = model_.dim();
  const auto n_modes = static_cast<Eigen::Index>(modes_.size());
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n_modes);
  for (Index node = 0; node < static_cast<Index>(part_of_node_.size()); ++node)
    if (part_of_node_[node] >= 0 && model_.nodes().is_own(node))
      for (Eigen::Index m = 0; m < n_modes; ++m)
      {
        const Eigen::Vector3d v = velocity(modes_[m], carrier(node), place(displacement, node));
        for (int c = 0; c < dim; ++c)
          load[m] -= residual[static_cast<std::size_t>(node) * dim + c] * v[c];
      }
  model_.nodes().sum_over_processes({load.data(), static_cast<std::size_t>(load.size())});
  std::vector<double> rigid_forces(static_cast<std::size_t>(model_.rigid().n_unknowns()), 0.0);
  model_.rigid().add_forces(time, rigid_forces);
  for (Eigen::Index m = 0; m < n_modes; ++m)
    if (const int b = model_.rigid().of_option(body_of_part_[modes_[m].component]); b >= 0)
    {
      const RigidBody &body = model_.rigid().bodies()[b];
      const Index unknown = (modes_[m].rotation ? body.rotation : body.translation)[modes_[m].axis].unknown;
      load[m] += rigid_forces[unknown] / (modes_[m].rotation ? size_[modes_[m].component] : 1);
    }
  return load;
}

std::optional<Eigen::VectorXd> FreeMotions::close_first(Displacement displacement,
                                                        std::vector<CandidateNode> &candidates,
                                                        const Eigen::VectorXd &motion, Decision &decision) const
{
  constexpr double never = std::numeric_limits<double>::infinity();
  double soonest = never;
  std::size_t chosen = 0;
  Eigen::VectorXd row = Eigen::VectorXd::Zero(motion.size());
  for (std::size_t k = 0; k < candidates.size(); ++k)
  {
    const CandidateNode &c = candidates[k];
    const Eigen::VectorXd over = over_modes(displacement, c.contact, c.node, c.gap_gradient);
    const double rate = over.dot(motion / motion.norm());
    if (rate >= -least_approach || c.gap / -rate >= soonest)
      continue;
    soonest = c.gap / -rate;
    chosen = k;
    row = over;
  }
  const Sharing &processes = model_.nodes();
  if (processes.true_on_all(soonest == never))
    return {};
  decision.closes = true;
  const double place = soonest == never ? 0 : model_.place_of(candidates[chosen].contact, candidates[chosen].node);
  if (is_greatest(processes, -soonest, place))
  {
    decision.closed.emplace_back(candidates[chosen].contact, candidates[chosen].node);
    candidates.erase(candidates.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  else
    row.setZero();
  processes.sum_over_processes({row.data(), static_cast<std::size_t>(row.size())});
  return row;
}

FreeMotions::Decision FreeMotions::decide(Displacement displacement, std::span<const HoldingNode> holding,
                                          std::vector<CandidateNode> candidates, std::span<const double> residual,
                                          double time, double force_scale)
{
  follow_halo();
  if (!model_.small_strain())
    center_ = centres(displacement);
  Decision decision;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(support_gram_.rows(), support_gram_.cols());
  for (const HoldingNode &node : holding)
  {
    const Eigen::VectorXd row = over_modes(displacement, node.contact, node.node, node.row);
    gram += row * row.transpose();
  }
  if (model_.small_strain())
  {
    sum_up(model_.nodes(), gram);
    gram += support_gram_;
  }
  else
  {
    add_supports(displacement, gram);
    sum_up(model_.nodes(), gram);
  }
  const Eigen::VectorXd load = loads(displacement, residual, time);
  while (true)
  {
    const Eigen::MatrixXd free = null_space(gram);
    if (free.cols() == 0)
      break;
    const Eigen::VectorXd motion = free * (free.transpose() * load);
    const bool loaded = motion.norm() > load_share * force_scale && force_scale > 0;
    if (const auto row = loaded ? close_first(displacement, candidates, motion, decision) : std::nullopt)
    {
      gram += *row * row->transpose();
      continue;
    }
    if (loaded)
      throw NumericalFailure(describe_loaded(motion));
    for (Eigen::Index k = 0; k < free.cols(); ++k)
      decision.held_modes.push_back(over_unknowns(displacement, free.col(k)));
    break;
  }
  std::sort(decision.closed.begin(), decision.closed.end());
  return decision;
}

std::string FreeMotions::describe_loaded(const Eigen::VectorXd &motion) const
{
  Eigen::Index m = 0;
  motion.cwiseAbs().maxCoeff(&m);
  std::ostringstream force;
  force << motion.norm();
  return "body '" + model_.options().bodies[body_of_part_[modes_[m].component]].name + "' moves freely (" +
         describe(motion) + "): neither a support nor a contact holds the load of " + force.str();
}

std::vector<double> FreeMotions::over_unknowns(Displacement displacement, const Eigen::VectorXd &motion) const
{
  std::vector<double> nodal(static_cast<std::size_t>(model_.n_nodal()), 0.0);
  for (Index node = 0; node < static_cast<Index>(part_of_node_.size()); ++node)
    if (part_of_node_[node] >= 0)
    {
      Eigen::Vector3d v = Eigen::Vector3d::Zero();
      for (std::size_t m = 0; m < modes_.size(); ++m)
        v += motion[static_cast<Eigen::Index>(m)] * velocity(modes_[m], carrier(node), place(displacement, node));
      for (int c = 0; c < model_.dim(); ++c)
        nodal[static_cast<std::size_t>(node) * model_.dim() + c] = std::abs(v[c]) > 1e-12 ? v[c] : 0;
    }
  std::vector<double> out(static_cast<std::size_t>(model_.layout().n_displacement_unknowns()), 0.0);
  model_.layout().gather(nodal, out);
  return out;
}
} // namespace amontons
