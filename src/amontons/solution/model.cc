#include "amontons/solution/model.h"

#include "amontons/bulk/loads_regions.h"
#include "amontons/parallel/agreement.h"
#include "amontons/solution/checkpoint.h"
#include "amontons/solution/form_choice.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace amontons
{
namespace
{
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
  read_part();
  const auto on_all = [this](void (Model::*work)())
  {
    if (messages_)
      agree_on_errors(messages_->communicator(), [&] { (this->*work)(); });
    else
      (this->*work)();
  };
  on_all(&Model::build_bodies);
  number_nodes({});
  on_all(&Model::build_contacts);
  build_search();
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
  {
    std::vector<Surface> sides = contact_sides(mesh(), contact, options_.bodies);
    const bool is_analytic = sides.size() == 1 && !contact.is_self_contact();
    if (contact.discretization == Discretization::mortar)
      part_.whole_surfaces.insert(part_.whole_surfaces.end(), sides.begin(), sides.end());
    else if (wants_whole_target(contact, options_.strain) && !is_analytic)
      part_.whole_surfaces.push_back(sides.back());
    std::move(sides.begin(), sides.end(), std::back_inserter(part_.surfaces));
  }
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
    std::vector<Index> &everywhere = rigid.nodes;
    if (options_.strain == Strain::finite)
      for (const Surface &smoothed : part_.whole_surfaces) // its normals turn with its nodes
        everywhere.insert(everywhere.end(), smoothed.node_ids.begin(), smoothed.node_ids.end());
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
}

State Model::initial_state() const
{
  State state;
  state.displacement.assign(static_cast<std::size_t>(n_state_nodes()) * dim(), 0);
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

Step Model::step_of(std::span<const double> increment) const
{
  Step out{{increment.begin(), increment.begin() + rigid_->n_unknowns()},
           std::vector<double>(static_cast<std::size_t>(n_state_nodes()) * dim(), 0.0),
           {increment.begin() + layout_.n_displacement_unknowns(), increment.end()}};
  for (std::size_t nodal = 0; nodal < out.displacement.size(); ++nodal)
    if (rigid_of_node_[nodal / dim()] < 0)
      for (const Term &term : layout_.terms(static_cast<Index>(nodal)))
        out.displacement[nodal] += increment[term.unknown];
  return out;
}

State Model::advance(State state, const Step &step, double share) const
{
  std::vector<double> rigid = step.rigid;
  for (double &value : rigid)
    value *= share;
  state.rigid = rigid_->advance(std::move(state.rigid), rigid);
  for (std::size_t i = 0; i < step.displacement.size(); ++i)
    state.displacement[i] += share * step.displacement[i];
  place_rigid_nodes(state);
  for (std::size_t m = 0; m < step.multipliers.size(); ++m)
    state.multipliers[m] += share * step.multipliers[m];
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
