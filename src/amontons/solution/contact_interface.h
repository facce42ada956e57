#pragma once
#include "amontons/bulk/rigid_bodies.h"
#include "amontons/contact/element.h"
#include "amontons/contact/options.h"
#include "amontons/detection/report.h"
#include "amontons/solution/contact_surfaces.h"
#include "amontons/solution/moving_mortar.h"
#include "amontons/solution/results.h"
#include "amontons/surface/shape.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// Nodes of a face at the most.
constexpr Index max_face_nodes = 4;

/// What a contact's nodes remember of the increments before.
struct ContactHistory
{
  std::vector<GlobalIndex> nodes;      ///< [n] of the impactor, positions in the whole mesh
  Pairing pairing;                     ///< [n], faces by their ids
  std::vector<GlobalIndex> face_nodes; ///< [n * max_face_nodes] of the face that each is paired with, or -1
  std::vector<ContactStatus> status;   ///< [n]
  std::vector<double> total_slip;      ///< as ContactResult::slip
};

/// Positive diagonal entries of the stiffness at some nodes: their sum, and how many. @param diagonal nodal
struct MeanStiffness
{
  MeanStiffness(std::span<const double> diagonal, std::span<const Index> nodes, int dim);
  double sum = 0;
  Index n = 0;
};

/// Impactor nodes' target faces, wherever they are: ids of their nodes, and positions once the process has them.
struct TargetFaces
{
  std::vector<GlobalIndex> ids; ///< [n * max_face_nodes], -1 behind a face's last node
  std::vector<Index> positions; ///< the same, on the process
};

/// One contact of the deck, on one process: the pairing and the history of the impactor nodes that it owns. Elements
/// belong to who owns the impactor node; target nodes may be copies that it has for that alone (Model's halo).
///
/// Displacements are nodal vectors [n_nodal], the halo's among them; `start` is the one at the beginning of the
/// increment. Local but for what says otherwise.
class ContactInterface
{
public:
  /// @param points reference places of all nodes of the process [n_nodal], by reference: the halo changes
  ContactInterface(const std::vector<double> &points, Kinematics kinematics, Strain strain,
                   const ContactOptions &options, const DetectionOptions &detection, ContactSurfaces surfaces,
                   const RigidBody *analytic_target);

  [[nodiscard]] const ContactOptions &options() const { return options_; }
  [[nodiscard]] const ContactSurfaces &surfaces() const { return surfaces_; }
  [[nodiscard]] const Surface &impactor() const { return surfaces_.impactor; }
  /// The target's surface of this process; null for an analytic one.
  [[nodiscard]] const Surface *target() const
  {
    return analytic_ ? nullptr : options_.is_self_contact() ? &surfaces_.impactor : &surfaces_.target.value();
  }
  [[nodiscard]] const std::vector<Index> &target_nodes() const
  {
    return options_.is_self_contact() ? surfaces_.nodes : surfaces_.target_nodes;
  }
  [[nodiscard]] Index n_nodes() const { return surfaces_.n_own; }
  /// Position of impactor node i among the process's nodes.
  [[nodiscard]] Index node(Index i) const { return surfaces_.nodes[i]; }
  [[nodiscard]] std::span<const double> areas() const { return areas_; }
  /// With mortar what of them sees the target, in finite strain now; whole where nothing does.
  [[nodiscard]] std::vector<double> covered_areas() const;
  /// Finds out which processes have which of the impactor's nodes. Collective.
  void share(std::shared_ptr<MessageExchange> messages);
  /// @param areas tributary ones, [n_nodes]
  void set_areas(std::vector<double> areas) { areas_ = std::move(areas); }
  [[nodiscard]] double augmentation(Index i) const { return augmentation_[i]; }
  /// The part of r that is not the user's: makes a force of a gap, for norms.
  [[nodiscard]] double stiffness(Index i) const { return augmentation_[i] / options_.augmentation; }
  [[nodiscard]] bool paired(Index i) const
  {
    if (left_out_[i])
      return false;
    if (moving_mortar_)
      return moving_mortar_->sees_target(i);
    return analytic_ || (mortar_ ? mortar_->sees_target(i) : pairing_[i].face >= 0);
  }
  /// Faces by their ids.
  [[nodiscard]] std::span<const Pair> pairing() const { return pairing_; }
  /// How often node i went to another face within the increment.
  [[nodiscard]] int n_face_changes(Index i) const { return n_face_changes_[i]; }

  /// r from the stiffness of the bodies: mean of the diagonal at the impactor node, or on the target where the impactor
  /// is rigid. @param diagonal [n_nodal], zero on rigid nodes @param on_target its mean over the target's nodes
  void set_augmentation(std::span<const double> diagonal, double on_target);

  /// Nodes of element i: the impactor node, then the face's, those that mortar couples it with, or the shape's point.
  [[nodiscard]] std::vector<Index> nodes(Index i) const;

  /// Measures gaps from those in this configuration: the overlaps where they are to be adjusted, all where the sides
  /// are tied; tied nodes without a pair here never have one. @return the deepest overlap that is adjusted, at least 0
  double set_initial_gap(std::span<const double> displacement);
  /// Mortar in finite strain: what set_initial_gap() found stays in sight, however little is moved at a time.
  /// @param deepest overlap of all processes
  void keep_in_sight(double deepest);

  /// Whether pairs come of a search for faces (take_pairs), and not of couple() or an analytic shape.
  [[nodiscard]] bool is_searched() const { return !analytic_ && !is_mortar(); }
  [[nodiscard]] bool is_mortar() const { return options_.discretization == Discretization::mortar; }

  /// Takes the faces that a search has found. @param found of the own nodes, faces by index on `target`
  /// @param keep hold on to the present face where the projection has hardly left it (within an increment)
  /// @return whether the face of any node changed: then place_faces() is needed
  bool take_pairs(const Pairing &found, const Surface &target, std::span<const double> displacement, bool keep);
  /// Mortar: couples what comes within `reach`, if the user gives no distance; in small strain in the reference and
  /// once for all. @return whether nodes() of any node changed
  bool couple(std::span<const double> displacement, double reach);
  /// Mortar in finite strain: gaps and linearisations are of this configuration from now on, which is the one that
  /// they have to be asked for. All others need no such call.
  void move_to(std::span<const double> displacement)
  {
    if (moving_mortar_)
      moving_mortar_->move_to(displacement);
  }
  /// Target nodes, by id, of present pairs and those at the increment's beginning.
  [[nodiscard]] std::vector<GlobalIndex> wanted_nodes() const;
  /// Takes the positions of the target nodes.
  void place_faces(const std::function<Index(GlobalIndex)> &position_of);
  /// Turns the tangential multipliers of nodes whose face take_pairs() changed into the frame of their new face.
  void turn_multipliers(std::span<const double> displacement, std::span<double> multipliers);

  /// Of couple(), or of what an analytic shape needs not search for; of this process's nodes.
  [[nodiscard]] DetectionReport detection_report() const;

  /// Takes note of the state at an increment's beginning: from where slip counts. @param reach as in couple()
  /// @return whether nodes() of any node changed, as where pairs that a failed attempt had changed are put back
  bool begin_increment(std::span<const double> start, double reach);

  /// Takes the state to which the increment leads with the statuses of its beginning: nodes that are open at the
  /// beginning take the origin of their slip, should they close, from the way to it (THEORY: the instant of closing):
  /// where the gap vanished, or its end. The first call within an increment counts.
  /// @return whether nodes() of any node changed
  bool set_trial(std::span<const double> displacement, std::span<const double> start);

  /// Gap of node i, which is paired.
  [[nodiscard]] double gap(Index i, std::span<const double> displacement) const
  {
    return moving_mortar_ ? moving_mortar_->gap(i) - gap_offset_[i]
                          : linearise_with_origin(i, displacement, displacement).gap;
  }

  /// Gap and slip of node i. A node that is closed before there is a trial state takes the present one for it.
  ContactLinearisation linearise(Index i, std::span<const double> displacement, std::span<const double> start);

  /// What sigma decides; stick where the sides are tied.
  [[nodiscard]] ContactStatus status(Index i, const ContactLinearisation &now, const Multipliers &lambda) const
  {
    return options_.tied ? ContactStatus::stick
                         : contact_status(now, lambda, options_.friction_coefficient, augmentation_[i]);
  }

  /// Everything known of the own nodes at a converged state; also the source of what commit() remembers.
  [[nodiscard]] ContactResult result(std::span<const double> displacement, std::span<const double> start,
                                     std::span<const double> multipliers);
  /// Adds the increment's slip to the totals.
  void commit(const ContactResult &result)
  {
    std::copy_n(result.slip.begin(), total_slip_.size(), total_slip_.begin());
    std::copy_n(result.status.begin(), status_.size(), status_.begin());
    start_pairing_ = pairing_;
    start_faces_ = faces_;
  }
  /// What commit() remembered; takes it up (place_faces() is needed then). @throws UserError where it is of other nodes
  [[nodiscard]] ContactHistory history() const;
  void set_history(const ContactHistory &history);
  /// Status at the end of the last increment.
  [[nodiscard]] ContactStatus committed_status(Index i) const { return status_[i]; }

  /// First multiplier of node i in State::multipliers.
  [[nodiscard]] Index multiplier(Index i) const { return first_multiplier_ + i * dim_; }
  void set_first_multiplier(Index first) { first_multiplier_ = first; }

private:
  /// Frame in which a node's tangential multipliers are still to be read.
  struct OldFrame
  {
    Index node;
    Eigen::Vector3d normal;
    std::array<Eigen::Vector3d, max_tangents> tangent;
  };
  /// The own nodes' part of a coupling of whole surfaces.
  struct MortarMeans
  {
    std::vector<char> sees; ///< [n_nodes]
    std::vector<Eigen::Vector3d> normal;
    std::vector<Index> offsets{0};    ///< [n_nodes + 1]
    std::vector<GlobalIndex> targets; ///< ids of target nodes
    std::vector<Index> positions;
    std::vector<double> weight;

    [[nodiscard]] bool sees_target(Index i) const { return sees[i] != 0; }
    template<class T>
    [[nodiscard]] std::span<const T> of(const std::vector<T> &values, Index i) const
    {
      return {values.data() + offsets[i], static_cast<std::size_t>(offsets[i + 1] - offsets[i])};
    }
  };
  [[nodiscard]] ContactLinearisation linearise_with_origin(Index i, std::span<const double> displacement,
                                                           std::span<const double> start) const;
  void find_closing_origin(Index i, double gap, std::span<const double> displacement, std::span<const double> start);
  void gather(std::span<const Index> nodes, std::span<const double> displacement, std::span<double> out) const;
  void add_reference(std::span<const Index> nodes, std::span<double> out) const;
  [[nodiscard]] std::span<const Index> face_nodes(Index i) const;
  [[nodiscard]] std::span<const double> normals_of_face(Index i) const;
  void smooth_target_normals(std::span<const double> start);
  [[nodiscard]] std::vector<double> target_weights(Index i) const;
  [[nodiscard]] Eigen::Vector3d relative(Index i, std::span<const double> displacement) const;
  void require_meshed_sides() const;
  bool start_mortar(std::span<const double> start, double reach);
  void couple_reference(double reach);
  [[nodiscard]] DetectionReport mortar_report() const;
  void set_face(Index i, const Pair &pair, const Surface &target);
  [[nodiscard]] bool keeps_face(Index i, const Pair &found, GlobalIndex face,
                                std::span<const double> displacement) const;

  const std::vector<double> &points_;
  int dim_;
  bool axisymmetric_;
  bool small_;
  ContactOptions options_;
  ContactSurfaces surfaces_;
  std::optional<Shape> analytic_;
  Index shape_node_ = -1;
  std::vector<double> areas_, augmentation_;
  std::optional<double> mortar_distance_;     ///< w: the user's, once coupled what was taken
  std::optional<MortarMeans> mortar_;         ///< small strain, once coupled
  std::optional<MovingMortar> moving_mortar_; ///< finite strain
  Pairing pairing_, start_pairing_;           ///< now, and at the increment's beginning; faces by their ids
  TargetFaces faces_, start_faces_;           ///< with them
  std::vector<Index> smoothed_positions_;     ///< of the whole target's nodes
  std::vector<double> target_normals_;        ///< at the corners of its faces at the increment's beginning, or empty
  std::vector<int> n_face_changes_;           ///< within the increment
  std::vector<Eigen::Vector3d> slip_origin_;
  std::vector<char> has_origin_;
  std::vector<double> start_gap_;
  std::vector<double> gap_offset_;    ///< initial gap that is taken as zero
  std::vector<char> left_out_;        ///< of tied nodes those that found no target at the start
  std::vector<ContactStatus> status_; ///< at the increment's beginning
  std::vector<double> total_slip_;    ///< [n * (dim-1)]
  std::vector<OldFrame> old_frames_;  ///< of nodes whose face the last take_pairs() changed, in 3D
  Index first_multiplier_ = 0;
};

/// Gives a result of own nodes those of others on the process's faces, and the sums and extremes of the whole.
/// Collective. @param impactor_nodes ContactSurfaces::sharing
void complete(ContactResult &result, const Sharing &impactor_nodes);
} // namespace amontons
