#include "amontons/solution/model.h"

#include "amontons/solution/form_choice.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
/// Components along which a node of a rigid body moves when its body turns about an axis.
int n_spins(int dim)
{
  return dim == 2 ? 1 : 3;
}
int spin_axis(int dim, int k)
{
  return dim == 2 ? 2 : k;
}
} // namespace

Model::Model(const ProblemOptions &options)
  : options_(options)
  , mesh_(read_mesh(options.mesh))
{
  const Kinematics kinematics = options_.mesh.kinematics;
  if ((kinematics == Kinematics::three_dimensional) != (mesh_.dim == 3))
    throw UserError(options_.mesh.where, "the mesh is " + std::to_string(mesh_.dim) +
                                             "-dimensional and does not fit the kinematics asked for");
  rigid_ = std::make_unique<RigidBodies>(mesh_, kinematics, options_.strain, options_.bodies, options_.boundary);
  supports_ =
      std::make_unique<Supports>(mesh_, kinematics, options_.bodies, options_.boundary, *rigid_, options_.loading.end);
  bodies_ = std::make_unique<BodyAssembly>(mesh_, kinematics, options_.strain, options_.bodies, options_.boundary,
                                           make_partition(options_, mesh_));

  rigid_of_node_.assign(static_cast<std::size_t>(mesh_.n_nodes() + rigid_->n_extra_nodes()), -1);
  for (std::size_t b = 0; b < rigid_->bodies().size(); ++b)
    for (const Index node : rigid_->bodies()[b].nodes)
      rigid_of_node_[node] = static_cast<int>(b);

  for (const ContactOptions &contact : options_.contact)
  {
    const RigidBody *analytic = nullptr;
    for (const RigidBody &body : rigid_->bodies())
      if (body.shape && body.name == contact.target)
        analytic = &body;
    contacts_.emplace_back(mesh_, kinematics, options_.strain, contact, options_.detection, analytic);
  }
  Index first = 0;
  for (ContactInterface &contact : contacts_)
  {
    contact.set_first_multiplier(first);
    first += contact.n_nodes() * dim();
  }
  build_layout();
}

Eigen::Vector3d Model::reference(Index node) const
{
  if (node >= mesh_.n_nodes())
    return rigid_->bodies()[rigid_of_node_[node]].point;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < dim(); ++c)
    x[c] = mesh_.points[static_cast<std::size_t>(node) * dim() + c];
  return x;
}

void Model::build_layout()
{
  std::vector<char> held(static_cast<std::size_t>(n_nodal()), 0);
  for (const HeldComponent &component : supports_->held())
    held[component.nodal] = 1;
  // Nodes of no deformable cell and no rigid body have no stiffness: they stay where they are.
  std::vector<char> stiff(rigid_of_node_.size(), 0);
  for (const SubdomainMatrix &matrix : bodies_->subdomains())
    for (const Index node : matrix.nodes)
      stiff[node] = 1;

  std::vector<Index> offsets{0};
  std::vector<Term> terms;
  Index n = rigid_->n_unknowns();
  for (Index node = 0; node < static_cast<Index>(rigid_of_node_.size()); ++node)
    for (int c = 0; c < dim(); ++c)
    {
      if (const int b = rigid_of_node_[node]; b >= 0)
      {
        const RigidBody &body = rigid_->bodies()[b];
        if (body.translation[c].unknown >= 0)
          terms.push_back({body.translation[c].unknown, 1});
        for (int k = 0; k < n_spins(dim()); ++k)
          if (const Index unknown = body.rotation[spin_axis(dim(), k)].unknown; unknown >= 0)
            terms.push_back({unknown, 0});
      }
      else if (stiff[node] && !held[node * dim() + c])
        terms.push_back({n++, 1});
      offsets.push_back(static_cast<Index>(terms.size()));
    }
  Index n_multipliers = 0;
  for (const ContactInterface &contact : contacts_)
    n_multipliers += contact.n_nodes() * dim();
  layout_ = Layout(n, n_multipliers, std::move(offsets), std::move(terms));
  update_layout(initial_state());
}

void Model::update_layout(const State &state)
{
  for (std::size_t b = 0; b < rigid_->bodies().size(); ++b)
  {
    const RigidBody &body = rigid_->bodies()[b];
    for (int k = 0; k < n_spins(dim()); ++k)
    {
      const int axis = spin_axis(dim(), k);
      if (body.rotation[axis].unknown < 0)
        continue;
      for (const Index node : body.nodes)
      {
        const Eigen::Vector3d velocity =
            rigid_->spin_velocity(static_cast<int>(b), state.rigid[b], reference(node), axis);
        for (int c = 0; c < dim(); ++c)
          for (Term &term : layout_.terms(node * dim() + c))
            if (term.unknown == body.rotation[axis].unknown)
              term.coefficient = velocity[c];
      }
    }
  }
}

State Model::initial_state() const
{
  State state;
  state.displacement.assign(static_cast<std::size_t>(n_nodal()), 0);
  state.rigid = rigid_->initial_state();
  state.multipliers.assign(static_cast<std::size_t>(layout_.n_multipliers()), 0);
  return state;
}

void Model::place_rigid_nodes(State &state) const
{
  for (std::size_t b = 0; b < rigid_->bodies().size(); ++b)
    for (const Index node : rigid_->bodies()[b].nodes)
    {
      const Eigen::Vector3d u = rigid_->displacement(static_cast<int>(b), state.rigid[b], reference(node));
      for (int c = 0; c < dim(); ++c)
        state.displacement[static_cast<std::size_t>(node) * dim() + c] = u[c];
    }
}

State Model::prescribe(State state, double time, double share) const
{
  for (const HeldComponent &held : supports_->held())
    state.displacement[held.nodal] += share * (supports_->value(held, time) - state.displacement[held.nodal]);
  state.rigid = rigid_->prescribe(std::move(state.rigid), time, share);
  place_rigid_nodes(state);
  return state;
}

State Model::advance(State state, std::span<const double> increment, double share) const
{
  std::vector<double> rigid(increment.begin(), increment.begin() + rigid_->n_unknowns());
  for (double &value : rigid)
    value *= share;
  state.rigid = rigid_->advance(std::move(state.rigid), rigid);
  for (Index nodal = 0; nodal < layout_.n_nodal(); ++nodal)
    if (rigid_of_node_[nodal / dim()] < 0)
      for (const Term &term : layout_.terms(nodal))
        state.displacement[nodal] += share * increment[term.unknown];
  place_rigid_nodes(state);
  for (Index m = 0; m < layout_.n_multipliers(); ++m)
    state.multipliers[m] += share * increment[layout_.multiplier(m)];
  return state;
}

std::vector<Reaction> Model::reactions(std::span<const double> residual) const
{
  std::vector<Reaction> entries(options_.boundary.size());
  std::vector<char> used(entries.size(), 0);
  for (const HeldComponent &held : supports_->held())
    if (held.entry >= 0)
    {
      entries[held.entry].region = options_.boundary[held.entry].region;
      entries[held.entry].force[held.nodal % dim()] += residual[held.nodal];
      used[held.entry] = 1;
    }
  std::vector<Reaction> out;
  for (std::size_t e = 0; e < entries.size(); ++e)
    if (used[e])
      out.push_back(entries[e]);
  for (const RigidBody &body : rigid_->bodies())
  {
    Reaction reaction{body.name, {0, 0, 0}};
    for (const Index node : body.nodes)
      for (int c = 0; c < dim(); ++c)
        reaction.force[c] += residual[static_cast<std::size_t>(node) * dim() + c];
    out.push_back(reaction);
  }
  return out;
}

double Model::prescribed_motion(double from, double to) const
{
  const State before = prescribe(initial_state(), from, 1), after = prescribe(initial_state(), to, 1);
  double largest = 0;
  for (std::size_t i = 0; i < before.displacement.size(); ++i)
    largest = std::max(largest, std::abs(after.displacement[i] - before.displacement[i]));
  return largest;
}
} // namespace amontons
