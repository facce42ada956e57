#pragma once
#include "amontons/solution/model.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace amontons
{
/// A contact node that holds motions back: its gap row and, where it sticks, its slip rows, over element dofs.
struct HoldingNode
{
  int contact;
  Index node;
  ContactVector row;
};

/// An open node that could stop a motion.
struct CandidateNode
{
  int contact;
  Index node;
  double gap; ///< with what the prescribed motion will do to it, length
  ContactVector gap_gradient;
};

/// Rigid motions that supports and closed contacts leave to the bodies.
///
/// Where contact alone holds a body, the tangent is singular while nothing touches. The rule for the first touch: along
/// a motion that carries load, the open pair that the load would close first is taken as closed for one iteration; so
/// the body moves until it touches, exactly. A motion without load is held in the mean (sum_i mode_i du_i = 0), which
/// costs no force. A loaded motion that no pair can stop is a failure named after its body.
class FreeMotions
{
public:
  /// Collective, as all members.
  explicit FreeMotions(const Model &model);

  /// Could any body move without its contacts? If not, nothing of this class is needed.
  [[nodiscard]] bool any() const { return any_; }

  /// @throws UserError for a body that would move freely even if all its contacts stuck
  void check_restrained() const;

  struct Decision
  {
    bool closes = false;                         ///< whether any process has a node to take as closed
    std::vector<std::pair<int, Index>> closed;   ///< own (contact, node) to take as closed in this iteration
    std::vector<std::vector<double>> held_modes; ///< over the displacement unknowns
  };
  /// @param displacement nodal, with the halo @param holding, candidates of this process
  /// @param residual nodal residual (internal - external + contact), [n_nodal], without the rigid bodies' own forces,
  ///        which are taken at `time`
  /// @param force_scale forces below 1e-10 of it are none
  /// @throws NumericalFailure: a load that nothing can hold
  [[nodiscard]] Decision decide(std::span<const double> displacement, std::span<const HoldingNode> holding,
                                std::vector<CandidateNode> candidates, std::span<const double> residual, double time,
                                double force_scale);

private:
  struct Mode
  {
    int component; ///< connected part
    int axis;      ///< direction, or axis of rotation
    bool rotation;
  };
  void join_nodes(std::vector<int> &parent, std::vector<int> &body_of_node) const;
  [[nodiscard]] double name_of(Index node) const;
  [[nodiscard]] std::vector<double> names_of_parts(std::vector<int> &parent, const std::vector<double> &body) const;
  void gather_parts(std::vector<std::pair<double, double>> &parts) const;
  void find_parts();
  void make_modes();
  /// What moves with a node.
  struct Carrier
  {
    int part = -1, rigid = -1; ///< connected part, rigid body
  };
  [[nodiscard]] Carrier carrier(Index node) const { return {part_of_node_[node], model_.rigid_of_node()[node]}; }
  /// What carries the node of a contact's target with the lowest number.
  [[nodiscard]] Carrier carrier_of_target(const ContactInterface &contact) const;
  void follow_halo();
  using Displacement = std::span<const double>; ///< nodal; empty: the reference
  /// Velocity of a node in a mode, per unit of the mode (rotations scaled to length by the part's size).
  [[nodiscard]] Eigen::Vector3d velocity(const Mode &mode, const Carrier &carrier, const Eigen::Vector3d &place) const;
  [[nodiscard]] Eigen::Vector3d place(Displacement displacement, Index node) const;
  /// Row of a contact element over the modes.
  [[nodiscard]] Eigen::VectorXd over_modes(Displacement displacement, int contact, Index node,
                                           const ContactVector &row) const;
  /// Calls add(part, node) for own nodes that move with a part as its own: of a rigid body those of that body.
  template<class Add>
  void over_own_nodes(Add &&add) const;
  /// Mean places of the parts' nodes: for a meshed rigid body where its point is.
  [[nodiscard]] std::vector<Eigen::Vector3d> centres(Displacement displacement) const;
  void find_sizes();
  void add_supports(Displacement displacement, Eigen::MatrixXd &gram) const;
  [[nodiscard]] std::vector<double> over_unknowns(Displacement displacement, const Eigen::VectorXd &motion) const;
  /// Load along each mode, the rigid bodies' own forces included.
  [[nodiscard]] Eigen::VectorXd loads(Displacement displacement, std::span<const double> residual, double time) const;
  /// The row, over the modes, of the pair that a motion would close first, of all processes; closed in `decision` by
  /// who has it, and no longer a candidate there. None where no pair can stop the motion.
  [[nodiscard]] std::optional<Eigen::VectorXd> close_first(Displacement displacement,
                                                           std::vector<CandidateNode> &candidates,
                                                           const Eigen::VectorXd &motion, Decision &decision) const;
  [[nodiscard]] std::string describe_loaded(const Eigen::VectorXd &motion) const;
  [[nodiscard]] std::string describe(const Eigen::VectorXd &motion) const;

  const Model &model_;
  std::vector<int> part_of_node_;       ///< connected part, -1: cannot move (held rigid bodies, unused nodes)
  int halo_version_;                    ///< to which it belongs
  std::vector<int> body_of_part_;       ///< position in the deck's bodies
  std::vector<Eigen::Vector3d> center_; ///< in finite strain where they are
  std::vector<double> size_;
  std::vector<Mode> modes_;
  Eigen::MatrixXd support_gram_; ///< of the reference
  bool any_ = false;
};
} // namespace amontons
