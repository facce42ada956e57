#pragma once
#include "amontons/algebra/system_form.h"
#include "amontons/solution/free_motions.h"
#include "amontons/solution/model.h"

#include <span>
#include <utility>
#include <vector>

namespace amontons
{
/// What the contacts add to a residual.
struct ContactContribution
{
  std::vector<double> force;            ///< F_x, nodal, [n_nodal], of all processes' elements
  std::vector<double> constraint;       ///< F_lambda, [n_multipliers]
  std::vector<double> prescribed_force; ///< K_c du and B du of the pending prescribed motion:
  std::vector<double> prescribed_gap;   ///< [n_nodal] and [n_multipliers]
  std::vector<ContactStatus> status;    ///< all contacts, own node by own node
  double constraint_norm2 = 0;          ///< sum (r F_lambda)^2, force^2, over all processes
  double force_norm2 = 0;               ///< sum of element forces' squares, over all processes
};

/// Writes the contacts' elements into the linearised system and the residual. Over several processes an element is
/// evaluated by the owner of its impactor node.
///
/// At nodes that a support holds, or that are impactors in several contacts, see DependentRows.
class ContactAssembly
{
public:
  ContactAssembly(Model &model, SystemForm &form);

  /// To be called whenever a face of some pair changed. Collective.
  void rebuild_pattern();

  /// Collective.
  /// @param start nodal displacement at the increment's beginning, as in a state
  /// @param pending prescribed motion still to come, as in a state; may be empty (then on all processes)
  /// @param forced (contact, node) to be taken as closed whatever sigma says, in ascending order
  /// @param first at an increment's beginning a closed node keeps the status it ended the last one with: at the limit
  /// of
  ///        friction sigma cannot tell stick from slip, and sliding that goes on is the likelier
  ContactContribution evaluate(const State &state, std::span<const double> start, std::span<const double> pending,
                               std::span<const std::pair<int, Index>> forced, bool first);

  /// The last evaluation is the state the next step starts from: its directions of slip are the ones that may not
  /// be reversed in one step. Forgotten at an increment's beginning.
  void remember_slip() { slip_direction_ = trial_direction_; }
  void forget_slip() { slip_direction_.clear(); }

  /// Closed nodes' rows and open nodes of the last evaluation, of this process, for FreeMotions.
  [[nodiscard]] const std::vector<HoldingNode> &holding() const { return holding_; }
  [[nodiscard]] const std::vector<CandidateNode> &candidates() const { return candidates_; }
  /// Record them from now on.
  void record_nodes() { record_nodes_ = true; }

private:
  struct Work
  {
    int contact;
    Index node;
    std::size_t block;
    ContactElement element;
  };
  void find_shared_nodes();
  [[nodiscard]] ContactStatus decide_status(const ContactInterface &contact, Index i, std::size_t block,
                                            const ContactLinearisation &now, const Multipliers &lambda);
  /// Nodal vectors with the halo.
  struct Motions
  {
    std::vector<double> now, start, pending;
  };
  void make_elements(const State &state, const Motions &motions, std::span<const std::pair<int, Index>> forced,
                     bool first, ContactContribution &out);
  [[nodiscard]] Work make_element(int c, Index i, std::size_t block, const State &state, const Motions &motions,
                                  bool forced, bool first);
  void drop_dependent_rows(std::span<Work *const> works, const State &state) const;
  void add(const Work &work, std::span<const double> pending, ContactContribution &out);
  void add_up(bool pending, ContactContribution &out) const;
  void write(std::size_t block, const ContactElement &element, double r);

  Model &model_;
  SystemForm &form_;
  std::vector<std::size_t> first_block_; ///< of each contact
  std::vector<char> special_;            ///< by node of the mesh: rows may depend on each other
  std::vector<HoldingNode> holding_;
  std::vector<CandidateNode> candidates_;
  bool record_nodes_ = false;
  std::vector<Eigen::Vector3d> slip_direction_, trial_direction_; ///< by block; zero where nothing slips
};
} // namespace amontons
