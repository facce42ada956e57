#pragma once
#include "amontons/bulk/mesh.h"
#include "amontons/bulk/rigid_bodies.h"
#include "amontons/contact/element.h"
#include "amontons/contact/mortar.h"
#include "amontons/contact/options.h"
#include "amontons/detection/detector.h"
#include "amontons/solution/results.h"
#include "amontons/surface/shape.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace amontons
{
/// What a contact's nodes remember of the increments before.
struct ContactHistory
{
  Pairing pairing;
  std::vector<ContactStatus> status;
  std::vector<double> total_slip; ///< as ContactResult::slip
};

/// The meshed sides of a contact: the impactor, then the target, if that is another surface of the mesh.
/// @throws UserError as extract_surface() and check_not_welded()
std::vector<Surface> contact_sides(const Mesh &mesh, const ContactOptions &options,
                                   const std::vector<BodyOptions> &bodies);

/// One contact of the deck: its surfaces, its pairing and the history of its nodes.
///
/// Displacements are nodal vectors [n_nodal] as in State; `start` is the one at the beginning of the increment.
class ContactInterface
{
public:
  /// @param impactor, target as from contact_sides(); no target in self-contact and where it is analytic
  ContactInterface(const Mesh &mesh, Kinematics kinematics, Strain strain, const ContactOptions &options,
                   const DetectionOptions &detection, Surface impactor, std::optional<Surface> target,
                   const RigidBody *analytic_target);

  [[nodiscard]] const ContactOptions &options() const { return options_; }
  [[nodiscard]] const Surface &impactor() const { return *impactor_; }
  [[nodiscard]] const Surface *target() const { return target_.get(); } ///< null for an analytic target
  [[nodiscard]] Index n_nodes() const { return impactor_->n_nodes(); }
  [[nodiscard]] std::span<const double> areas() const { return areas_; }
  [[nodiscard]] double augmentation(Index i) const { return augmentation_[i]; }
  /// The part of r that is not the user's: makes a force of a gap, for norms.
  [[nodiscard]] double stiffness(Index i) const { return augmentation_[i] / options_.augmentation; }
  [[nodiscard]] bool paired(Index i) const
  {
    return analytic_ || (mortar_ ? mortar_->sees_target(i) : pairing_[i].face >= 0);
  }
  [[nodiscard]] std::span<const Pair> pairing() const { return pairing_; }
  [[nodiscard]] DetectionReport detection_report() const;
  /// How often node i went to another face within the increment.
  [[nodiscard]] int n_face_changes(Index i) const { return n_face_changes_[i]; }

  /// r from the stiffness of the bodies: mean of the diagonal at the impactor node, or on the target where the impactor
  /// is rigid. @param diagonal [n_nodal], zero on rigid nodes
  void set_augmentation(std::span<const double> diagonal);

  /// Nodes of element i: the impactor node, then the face's, those that mortar couples it with, or the shape's point.
  [[nodiscard]] std::vector<Index> nodes(Index i) const;

  /// Measures gaps from those in this configuration: the overlaps where they are to be adjusted, all where the sides
  /// are tied.
  void set_initial_gap(std::span<const double> displacement);

  /// Detects in the given configuration. In small strain only the reference counts.
  /// @param keep hold on to the present face where the projection has hardly left it (within an increment)
  /// @return whether the face of any node changed
  bool detect(std::span<const double> displacement, double reach, bool keep);

  /// Takes note of the state at an increment's beginning: from where slip counts. @return whether pairs that a failed
  /// attempt had changed were put back
  bool begin_increment(std::span<const double> start);

  /// Takes the state to which the increment leads with the statuses of its beginning: nodes that are open at the
  /// beginning take the origin of their slip, should they close, from the way to it (THEORY: the instant of closing):
  /// where the gap vanished, or its end. The first call within an increment counts.
  void set_trial(std::span<const double> displacement, std::span<const double> start);

  /// Gap of node i, which is paired.
  [[nodiscard]] double gap(Index i, std::span<const double> displacement) const
  {
    return linearise_with_origin(i, displacement, displacement).gap;
  }

  /// Gap and slip of node i. A node that is closed before there is a trial state takes the present one for it.
  ContactLinearisation linearise(Index i, std::span<const double> displacement, std::span<const double> start);

  /// What sigma decides; stick where the sides are tied.
  [[nodiscard]] ContactStatus status(Index i, const ContactLinearisation &now, const Multipliers &lambda) const
  {
    return options_.tied ? ContactStatus::stick
                         : contact_status(now, lambda, options_.friction_coefficient, augmentation_[i]);
  }

  /// Turns the tangential multipliers of nodes whose face detect() changed into the frame of their new face.
  void turn_multipliers(std::span<const double> displacement, std::span<double> multipliers);

  /// Everything known at a converged state; also the source of what commit() remembers.
  [[nodiscard]] ContactResult result(std::span<const double> displacement, std::span<const double> start,
                                     std::span<const double> multipliers);
  /// Adds the increment's slip to the totals.
  void commit(const ContactResult &result)
  {
    total_slip_ = result.slip;
    status_ = result.status;
    start_pairing_ = pairing_;
  }
  /// What commit() remembered; takes it up. @throws UserError where it is of other nodes
  [[nodiscard]] ContactHistory history() const { return {start_pairing_, status_, total_slip_}; }
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
  [[nodiscard]] ContactLinearisation linearise_with_origin(Index i, std::span<const double> displacement,
                                                           std::span<const double> start) const;
  void find_closing_origin(Index i, const ContactLinearisation &now, std::span<const double> displacement,
                           std::span<const double> start);
  void gather(std::span<const Index> nodes, std::span<const double> displacement, std::span<double> out) const;
  void add_reference(std::span<const Index> nodes, std::span<double> out) const;
  [[nodiscard]] std::span<const double> normals_of_face(Index i) const;
  void smooth_target_normals(std::span<const double> start);
  [[nodiscard]] bool is_mortar() const { return options_.discretization == Discretization::mortar; }
  [[nodiscard]] std::vector<double> target_weights(Index i) const;
  [[nodiscard]] Eigen::Vector3d relative(Index i, std::span<const double> displacement) const;
  void require_meshed_sides() const;
  void couple(double reach);
  void report_mortar(double w);
  [[nodiscard]] bool keeps_face(Index i, const Pair &found, std::span<const double> displacement) const;

  const Mesh &mesh_;
  int dim_;
  bool axisymmetric_;
  bool small_;
  ContactOptions options_;
  std::shared_ptr<const Surface> impactor_, target_; ///< in self-contact the same
  std::optional<Shape> analytic_;
  Index shape_node_ = -1;
  std::vector<double> areas_, augmentation_;
  std::unique_ptr<Detector> detector_;    ///< node-to-face
  std::optional<double> mortar_distance_; ///< the user's w
  std::optional<MortarCoupling> mortar_;  ///< as last detected
  DetectionReport mortar_report_;
  Pairing pairing_, start_pairing_;    ///< now, and at the increment's beginning
  std::vector<double> target_normals_; ///< at the corners of the target's faces at the increment's beginning, or empty
  std::vector<int> n_face_changes_;    ///< within the increment
  std::vector<Eigen::Vector3d> slip_origin_;
  std::vector<char> has_origin_;
  std::vector<double> start_gap_;
  std::vector<double> gap_offset_;    ///< initial gap that is taken as zero
  std::vector<ContactStatus> status_; ///< at the increment's beginning
  std::vector<double> total_slip_;    ///< [n * (dim-1)]
  std::vector<OldFrame> old_frames_;  ///< of nodes whose face the last detect() changed, in 3D
  Index first_multiplier_ = 0;
};
} // namespace amontons
