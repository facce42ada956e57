#pragma once
#include "amontons/solution/given_motions.h"

#include <optional>
#include <vector>

namespace amontons
{
/// Where the last increment began, and when.
struct LastIncrement
{
  State start;
  double from = 0, to = 0;
};

/// Where an increment may end, or Newton's method start from. All that supports make rigid motions of is taken out of
/// it (GivenMotions) before anything is extrapolated or compared, so that nothing depends on the frame that the problem
/// is seen from, moving as it may.
class Predictor
{
public:
  /// Collective, as all that follows.
  explicit Predictor(Model &model)
    : model_(model)
    , given_(model)
  {
  }

  /// The increment that converged last.
  [[nodiscard]] const std::optional<LastIncrement> &last() const { return last_; }
  void set_last(std::optional<LastIncrement> last) { last_ = std::move(last); }

  /// The state at time `to` if displacements, rigid motions and multipliers go on as in the last increment, as far as
  /// the loads do. None where the loads turn to another direction.
  /// @param now the state at time `from`, the last one remembered
  [[nodiscard]] std::optional<State> guess(const State &now, double from, double to);

  /// The present state carried along by the observer until a time: what it is to him, all of the motion that he sees is
  /// still to come.
  [[nodiscard]] State carried(const State &now, double to) const;
  /// The state at a time if every body moves as its supports do in the mean.
  [[nodiscard]] State approach(const State &now, double to) const;
  /// Own nodes (contact, node) that are open and close on the way to `approach`.
  [[nodiscard]] std::vector<std::pair<int, Index>> touching(const State &now, const State &approach);

private:
  struct Loads
  {
    std::vector<double> displacement; ///< as in a state, zero where it is not given
    std::vector<double> force;        ///< nodal
    std::vector<double> on_rigid;     ///< forces on the rigid bodies' unknowns
  };
  /// The loads of a time on the bodies as they are now, to the observer now.
  /// @param carried his motion from that time until now
  [[nodiscard]] Loads loads(const State &now, double time, const RigidMotion &carried);
  void turn(Loads &loads, const Eigen::Matrix3d &rotation) const;
  /// The factor by which the loads' change from `from` to `to` is the one from start to `from`, if it is one.
  [[nodiscard]] std::optional<double> load_ratio(const State &now, double from, double to);

  Model &model_;
  const GivenMotions given_;
  std::optional<LastIncrement> last_;
};
} // namespace amontons
