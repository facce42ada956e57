#include "amontons/solution/model.h"

#include "amontons/bulk/loads_regions.h"
#include "amontons/parallel/agreement.h"
#include "amontons/solution/checkpoint.h"
#include "amontons/solution/form_choice.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

/// Whether a facet lies between two cells only the whole mesh can tell.
void check_pressures(const Mesh &mesh, const ProblemOptions &options, const std::vector<bool> &is_rigid)
{
  std::vector<Index> deformable;
  for (const bool rigid : is_rigid)
    deformable.push_back(rigid ? -1 : 0);
  const LoadRegions regions(mesh, options.bodies, deformable, {});
  for (const BoundaryOptions &entry : options.boundary)
    if (entry.pressure && !regions.is_rigid(entry))
      (void)regions.facets(entry, true);
}

/// Cells and nodes of meshed rigid bodies.
struct RigidParts
{
  std::vector<bool> is_rigid; ///< [n_cells]
  std::vector<Index> nodes;
};

RigidParts rigid_parts(const Mesh &mesh, const std::vector<BodyOptions> &bodies)
{
  RigidParts out{std::vector<bool>(static_cast<std::size_t>(mesh.cells.size()), false), {}};
  for (const BodyOptions &body : bodies)
  {
    if (body.material.law != MaterialLaw::rigid || body.shape)
      continue;
    const Group &group = find_group(mesh, body.region, -1, body.where);
    for (const Index cell : group.cells)
      out.is_rigid[cell] = true;
    const std::vector<Index> nodes = group.nodes();
    out.nodes.insert(out.nodes.end(), nodes.begin(), nodes.end());
  }
  return out;
}
} // namespace

Model::Model(const ProblemOptions &options, std::shared_ptr<MessageExchange> messages)
  : options_(options)
  , messages_(std::move(messages))
{
  const auto on_all = [this](void (Model::*work)())
  {
    if (messages_)
      agree_on_errors(messages_->communicator(), [&] { (this->*work)(); });
    else
      (this->*work)();
  };
  read_part();
  on_all(&Model::build_bodies);
  on_all(&Model::build_contacts);
  share_nodes();
  build_layout();
}

/// The whole mesh with what is known of it as a whole.
void Model::read_whole(int n_processes)
{
  part_.mesh = read_mesh(options_.mesh);
  if ((options_.mesh.kinematics == Kinematics::three_dimensional) != (mesh().dim == 3))
    throw UserError(options_.mesh.where, "the mesh is " + std::to_string(mesh().dim) +
                                             "-dimensional and does not fit the kinematics asked for");
  for (const ContactOptions &contact : options_.contact)
    for (Surface &side : contact_sides(mesh(), contact, options_.bodies))
      part_.surfaces.push_back(std::move(side));
  part_.subdomain_of_cell = make_partition(options_, mesh(), n_processes);
  problem_key_ = amontons::problem_key(options_, mesh());
}

/// On process 0 the whole, then on each its part.
void Model::read_part()
{
  if (!messages_ || messages_->communicator().size() == 1)
  {
    read_whole(1);
    return;
  }
  const Communicator &all = messages_->communicator();
  std::vector<Rank> process_of_cell;
  RigidParts rigid;
  const auto read_and_divide = [&]
  {
    read_whole(all.size());
    rigid = rigid_parts(mesh(), options_.bodies);
    check_pressures(mesh(), options_, rigid.is_rigid);
    process_of_cell = processes_of_cells(mesh(), part_.subdomain_of_cell, rigid.is_rigid, all.size());
  };
  agree_on_errors(all,
                  [&]
                  {
                    if (all.is_root())
                      read_and_divide();
                  });
  part_ = distribute(*messages_, part_, process_of_cell, rigid.is_rigid, rigid.nodes);
  problem_key_ = std::stoull(all.broadcast(std::to_string(problem_key_), 0));
}

void Model::build_bodies()
{
  const Kinematics kinematics = options_.mesh.kinematics;
  rigid_ = std::make_unique<RigidBodies>(mesh(), kinematics, options_.strain, options_.bodies, options_.boundary);
  supports_ =
      std::make_unique<Supports>(mesh(), kinematics, options_.bodies, options_.boundary, *rigid_, options_.loading.end);
  bodies_ = std::make_unique<BodyAssembly>(mesh(), kinematics, options_.strain, options_.bodies, options_.boundary,
                                           part_.subdomain_of_cell);

  rigid_of_node_.assign(static_cast<std::size_t>(mesh().n_nodes() + rigid_->n_extra_nodes()), -1);
  for (std::size_t b = 0; b < rigid_->bodies().size(); ++b)
    for (const Index node : rigid_->bodies()[b].nodes)
      rigid_of_node_[node] = static_cast<int>(b);
}

void Model::build_contacts()
{
  auto surface = part_.surfaces.begin();
  for (const ContactOptions &contact : options_.contact)
  {
    const RigidBody *analytic = nullptr;
    for (const RigidBody &body : rigid_->bodies())
      if (body.shape && body.name == contact.target)
        analytic = &body;
    Surface impactor = std::move(*surface++);
    std::optional<Surface> target;
    if (!analytic && !contact.is_self_contact())
      target = std::move(*surface++);
    contacts_.emplace_back(mesh(), options_.mesh.kinematics, options_.strain, contact, options_.detection,
                           std::move(impactor), std::move(target), analytic);
  }
  AMONTONS_ASSERT(surface == part_.surfaces.end());
  part_.surfaces.clear();
  Index first = 0;
  for (ContactInterface &contact : contacts_)
  {
    contact.set_first_multiplier(first);
    first += contact.n_nodes() * dim();
  }
}

/// A node belongs to a process that has a deformable cell at it, where there is one.
void Model::share_nodes()
{
  std::vector<GlobalIndex> ids = mesh().node_ids;
  for (Index k = 0; k < rigid_->n_extra_nodes(); ++k)
    ids.push_back(node_id(mesh().n_nodes() + k));
  std::vector<char> has_cell(ids.size(), 0);
  for (const SubdomainMatrix &matrix : bodies_->subdomains())
    for (const Index node : matrix.nodes)
      has_cell[node] = 1;
  nodes_ = Sharing(messages_, "model", ids, has_cell);
}

Eigen::Vector3d Model::reference(Index node) const
{
  if (node >= mesh().n_nodes())
    return rigid_->bodies()[rigid_of_node_[node]].point;
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  for (int c = 0; c < dim(); ++c)
    x[c] = mesh().points[static_cast<std::size_t>(node) * dim() + c];
  return x;
}

void Model::build_layout()
{
  std::vector<char> held(static_cast<std::size_t>(n_nodal()), 0);
  for (const HeldComponent &component : supports_->held())
    held[component.nodal] = 1;
  // Nodes of no deformable cell and no rigid body have no stiffness: they stay where they are.
  std::vector<double> stiff(rigid_of_node_.size(), 0);
  for (const SubdomainMatrix &matrix : bodies_->subdomains())
    for (const Index node : matrix.nodes)
      stiff[node] = 1;
  nodes_.maximum(stiff);

  std::vector<Index> offsets{0};
  std::vector<Term> terms;
  Index n = rigid_->n_unknowns();
  std::vector<GlobalIndex> ids(static_cast<std::size_t>(n));
  std::iota(ids.begin(), ids.end(), 0);
  std::vector<char> preferred(ids.size(), 0);
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
      else if (stiff[node] != 0 && !held[node * dim() + c])
      {
        terms.push_back({n++, 1});
        ids.push_back(rigid_->n_unknowns() + node_id(node) * dim() + c);
        preferred.push_back(nodes_.is_own(node) ? 1 : 0);
      }
      offsets.push_back(static_cast<Index>(terms.size()));
    }
  Index n_multipliers = 0;
  for (const ContactInterface &contact : contacts_)
    n_multipliers += contact.n_nodes() * dim();
  layout_ = Layout(Sharing(messages_, "model", ids, preferred), n_multipliers, std::move(offsets), std::move(terms));
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
  std::vector<double> sums(4 * entries.size(), 0.0); // three components, and how many nodes
  for (const HeldComponent &held : supports_->held())
    if (held.entry >= 0 && nodes_.is_own(held.nodal / dim()))
    {
      sums[static_cast<std::size_t>(4 * held.entry + held.nodal % dim())] += residual[held.nodal];
      ++sums[static_cast<std::size_t>(4 * held.entry + 3)];
    }
  nodes_.sum_over_processes(sums);
  for (std::size_t e = 0; e < entries.size(); ++e)
  {
    entries[e].region = options_.boundary[e].region;
    std::copy_n(sums.begin() + static_cast<std::ptrdiff_t>(4 * e), 3, entries[e].force.begin());
  }
  std::vector<Reaction> out;
  for (std::size_t e = 0; e < entries.size(); ++e)
    if (sums[4 * e + 3] > 0)
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
  return nodes_.maximum_over_processes(largest);
}
} // namespace amontons
