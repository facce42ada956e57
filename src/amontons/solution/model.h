#pragma once
#include "amontons/algebra/layout.h"
#include "amontons/bulk/assembly.h"
#include "amontons/bulk/mesh_distribution.h"
#include "amontons/bulk/rigid_bodies.h"
#include "amontons/bulk/supports.h"
#include "amontons/solution/contact_interface.h"
#include "amontons/solution/options.h"
#include "amontons/solution/state.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace amontons
{
/// The problem built: mesh, bodies, supports, contacts and the numbering of unknowns.
///
/// Over several processes each has its part of the mesh (MeshPart) and of the bodies. Contacts are on all of them
/// alike: every process computes all of them from the same numbers and comes to the same ones, bit by bit.
class Model
{
public:
  /// Process 0 reads the mesh. Collective.
  /// @param messages between the processes; null for one process
  /// @throws UserError, on all processes, for everything that only the mesh can tell is wrong
  explicit Model(const ProblemOptions &options, std::shared_ptr<MessageExchange> messages = nullptr);

  [[nodiscard]] const ProblemOptions &options() const { return options_; }
  [[nodiscard]] const Mesh &mesh() const { return part_.mesh; }
  /// Of nodes: those of the mesh, then the points of analytic bodies. A nodal vector of forces of bodies is a sum over
  /// the processes; everything else nodal is the same on all copies.
  [[nodiscard]] const Sharing &nodes() const { return nodes_; }
  /// Number of a node in the whole, the points of analytic bodies behind the mesh's.
  [[nodiscard]] GlobalIndex node_id(Index node) const
  {
    return node < mesh().n_nodes() ? mesh().node_ids[node] : mesh().n_global_nodes + node - mesh().n_nodes();
  }
  /// See problem_key() in checkpoint.h.
  [[nodiscard]] std::uint64_t problem_key() const { return problem_key_; }
  /// Over all processes.
  [[nodiscard]] GlobalIndex n_global_unknowns() const { return layout_.sharing().n_global() + layout_.n_multipliers(); }
  [[nodiscard]] int dim() const { return part_.mesh.dim; }
  [[nodiscard]] bool small_strain() const { return options_.strain == Strain::small; }
  [[nodiscard]] const RigidBodies &rigid() const { return *rigid_; }
  [[nodiscard]] const Supports &supports() const { return *supports_; }
  [[nodiscard]] BodyAssembly &bodies() { return *bodies_; }
  [[nodiscard]] const BodyAssembly &bodies() const { return *bodies_; }
  [[nodiscard]] std::vector<ContactInterface> &contacts() { return contacts_; }
  [[nodiscard]] const std::vector<ContactInterface> &contacts() const { return contacts_; }
  [[nodiscard]] bool has_friction() const
  {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [](const ContactInterface &c) { return c.options().friction_coefficient > 0; });
  }
  [[nodiscard]] const Layout &layout() const { return layout_; }

  [[nodiscard]] Index n_nodal() const { return (mesh().n_nodes() + rigid_->n_extra_nodes()) * dim(); }
  /// Part of a nodal vector that belongs to the mesh.
  template<class Vector>
  [[nodiscard]] auto mesh_part(Vector &nodal) const
  {
    return std::span(nodal).first(static_cast<std::size_t>(mesh().n_nodes()) * dim());
  }
  /// Rigid body of each nodal position, -1 for none. [n_nodes + n_extra_nodes]
  [[nodiscard]] const std::vector<int> &rigid_of_node() const { return rigid_of_node_; }
  /// Reference place of a node, extra nodes included.
  [[nodiscard]] Eigen::Vector3d reference(Index node) const;

  [[nodiscard]] State initial_state() const;
  /// The state with its prescribed displacements moved to their values at `time` by the fraction `share` of the way.
  [[nodiscard]] State prescribe(State state, double time, double share) const;
  /// The state after its unknowns moved by `share` of `increment` [n_unknowns].
  [[nodiscard]] State advance(State state, std::span<const double> increment, double share) const;
  /// Gives the layout the lever arms of rigid rotations in this state.
  void update_layout(const State &state);
  /// Boundary entries and rigid bodies with the force each puts on the rest. Collective.
  /// @param residual nodal, the same on all copies
  [[nodiscard]] std::vector<Reaction> reactions(std::span<const double> residual) const;
  /// Largest prescribed displacement change from one time to another, length. Collective.
  [[nodiscard]] double prescribed_motion(double from, double to) const;

private:
  void read_whole(int n_processes);
  void read_part();
  void build_bodies();
  void build_contacts();
  void share_nodes();
  void build_layout();
  void place_rigid_nodes(State &state) const;

  ProblemOptions options_;
  std::shared_ptr<MessageExchange> messages_;
  MeshPart part_;
  std::uint64_t problem_key_ = 0;
  Sharing nodes_;
  std::unique_ptr<RigidBodies> rigid_;
  std::unique_ptr<Supports> supports_;
  std::unique_ptr<BodyAssembly> bodies_;
  std::vector<ContactInterface> contacts_;
  std::vector<int> rigid_of_node_;
  Layout layout_;
};
} // namespace amontons
