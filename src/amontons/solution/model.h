#pragma once
#include "amontons/algebra/layout.h"
#include "amontons/bulk/assembly.h"
#include "amontons/bulk/mesh_distribution.h"
#include "amontons/bulk/rigid_bodies.h"
#include "amontons/bulk/supports.h"
#include "amontons/solution/contact_search.h"
#include "amontons/solution/options.h"
#include "amontons/solution/state.h"

#include <algorithm>
#include <memory>
#include <unordered_map>
#include <vector>

namespace amontons
{
/// The problem built: mesh, bodies, supports, contacts and the numbering of unknowns.
///
/// Over several processes each has its part of the mesh (MeshPart), of the bodies and of the contacts: the elements of
/// the impactor nodes that it owns. Its nodes are those of its mesh, then the points of analytic bodies, and last the
/// *halo*: target nodes that its elements couple and that no cell of it has. The halo follows the pairs.
class Model
{
public:
  /// Process 0 reads the mesh. Collective.
  /// @param messages between the processes; null for one process
  /// @throws UserError, on all processes, for everything that only the mesh can tell is wrong
  explicit Model(const ProblemOptions &options, std::shared_ptr<MessageExchange> messages = nullptr);
  Model(const Model &) = delete; // contacts and forms refer to parts of it
  Model &operator=(const Model &) = delete;

  [[nodiscard]] const ProblemOptions &options() const { return options_; }
  [[nodiscard]] const Mesh &mesh() const { return part_.mesh; }
  /// Of all nodes. A nodal vector of forces is a sum over the processes; everything else nodal is the same on all
  /// copies.
  [[nodiscard]] const Sharing &nodes() const { return nodes_; }
  /// Number of a node in the whole, the points of analytic bodies behind the mesh's. [n_nodes]
  [[nodiscard]] const std::vector<GlobalIndex> &node_ids() const { return node_ids_; }
  [[nodiscard]] GlobalIndex node_id(Index node) const { return node_ids_[node]; }
  /// Position of a node on the process. @throws std::out_of_range if it has none
  [[nodiscard]] Index position(GlobalIndex id) const
  {
    return nodes_.is_distributed() ? position_of_id_.at(id) : static_cast<Index>(id);
  }
  /// See problem_key() in checkpoint.h.
  [[nodiscard]] std::uint64_t problem_key() const { return problem_key_; }
  /// Over all processes.
  [[nodiscard]] GlobalIndex n_global_unknowns() const { return layout_.sharing().n_global() + n_global_multipliers_; }
  [[nodiscard]] int dim() const { return part_.mesh.dim; }
  [[nodiscard]] bool small_strain() const { return options_.strain == Strain::small; }
  [[nodiscard]] const RigidBodies &rigid() const { return *rigid_; }
  [[nodiscard]] const Supports &supports() const { return *supports_; }
  [[nodiscard]] BodyAssembly &bodies() { return *bodies_; }
  [[nodiscard]] const BodyAssembly &bodies() const { return *bodies_; }
  /// Whether one assembly of the bodies' stiffness serves the whole run, on all processes.
  [[nodiscard]] bool tangent_is_constant() const { return tangent_is_constant_; }
  [[nodiscard]] std::vector<ContactInterface> &contacts() { return contacts_; }
  [[nodiscard]] const std::vector<ContactInterface> &contacts() const { return contacts_; }
  /// Orders impactor nodes of all contacts: by contact, then by the node's position in the whole mesh.
  [[nodiscard]] double place_of(std::size_t contact, Index node) const
  {
    return static_cast<double>(contact) * static_cast<double>(mesh().n_global_nodes) +
           static_cast<double>(contacts_[contact].impactor().node_ids[node]);
  }
  [[nodiscard]] bool has_friction() const
  {
    return std::any_of(contacts_.begin(), contacts_.end(),
                       [](const ContactInterface &c) { return c.options().friction_coefficient > 0; });
  }
  [[nodiscard]] const Layout &layout() const { return layout_; }

  /// Components of all nodes, the halo's too.
  [[nodiscard]] Index n_nodal() const { return static_cast<Index>(node_ids_.size()) * dim(); }
  /// Nodes without the halo: those of a state.
  [[nodiscard]] Index n_state_nodes() const { return mesh().n_nodes() + rigid_->n_extra_nodes(); }
  /// A state's displacements, or another nodal vector without the halo, with the halo's from their owners. Collective.
  [[nodiscard]] std::vector<double> with_halo(std::span<const double> nodal) const;
  /// Counts the halos there have been; the same on all processes.
  [[nodiscard]] int halo_version() const { return halo_version_; }
  /// Part of a nodal vector that belongs to the mesh.
  template<class Vector>
  [[nodiscard]] auto mesh_part(Vector &nodal) const
  {
    return std::span(nodal).first(static_cast<std::size_t>(mesh().n_nodes()) * dim());
  }
  /// Rigid body of each node, -1 for none. [n_nodes]
  [[nodiscard]] const std::vector<int> &rigid_of_node() const { return rigid_of_node_; }
  /// Reference places of all nodes. [n_nodal]
  [[nodiscard]] const std::vector<double> &points() const { return points_; }
  /// Reference place of a node.
  [[nodiscard]] Eigen::Vector3d reference(Index node) const;

  [[nodiscard]] State initial_state() const;
  /// The state with its prescribed displacements moved to their values at `time` by the fraction `share` of the way.
  [[nodiscard]] State prescribe(State state, double time, double share) const;
  /// A step of the unknowns [n_unknowns] as one of what a state holds, which no layout changes.
  [[nodiscard]] Step step_of(std::span<const double> increment) const;
  /// The state after `share` of a step.
  [[nodiscard]] State advance(State state, const Step &step, double share) const;
  /// Gives the layout the lever arms of rigid rotations in this state.
  void update_layout(const State &state);

  /// Searches the faces of all contacts in a state, and makes the halo that they ask for; tangential multipliers go
  /// along to new faces. In small strain in the reference, once. Collective.
  /// @param reaches by contact, see Detector::detect @param keep see ContactInterface::take_pairs()
  /// @throws NumericalFailure on all; faces and halo may have changed then
  /// @return whether the face of any node of any process changed
  bool detect(State &state, std::span<const double> reaches, bool keep);
  /// Makes the halo that the contacts' pairs ask for. Collective.
  void update_halo();
  /// Of a contact's last search, of this process's nodes.
  [[nodiscard]] DetectionReport detection_report(std::size_t contact) const
  {
    return search_ ? search_->report(contact) : detection_reports_[contact];
  }
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
  [[nodiscard]] ContactSurfaces share_of(const Surface &impactor) const;
  void build_search();
  void number_nodes(std::vector<GlobalIndex> halo);
  void build_layout();
  void place_rigid_nodes(State &state) const;

  ProblemOptions options_;
  std::shared_ptr<MessageExchange> messages_;
  MeshPart part_;
  std::uint64_t problem_key_ = 0;
  std::vector<GlobalIndex> node_ids_;
  std::unordered_map<GlobalIndex, Index> position_of_id_; ///< over several processes
  std::vector<double> points_;
  int halo_version_ = 0;
  Sharing nodes_;
  std::unique_ptr<RigidBodies> rigid_;
  std::unique_ptr<Supports> supports_;
  std::unique_ptr<BodyAssembly> bodies_;
  bool tangent_is_constant_ = false;
  std::vector<ContactInterface> contacts_;
  std::unique_ptr<ContactSearch> search_;          ///< in small strain until it has found the pairs, for good
  std::vector<DetectionReport> detection_reports_; ///< from then on
  GlobalIndex n_global_multipliers_ = 0;
  std::vector<int> rigid_of_node_;
  Layout layout_;
};
} // namespace amontons
