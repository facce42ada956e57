#pragma once
#include "amontons/solution/model.h"

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

/// Guess of an increment's end: displacements, rigid motions and multipliers go on as in the last increment, as far as
/// the loads do. There is no guess where the loads turn to another direction.
class Predictor
{
public:
  explicit Predictor(Model &model)
    : model_(model)
  {
  }

  /// The increment that converged last.
  [[nodiscard]] const std::optional<LastIncrement> &last() const { return last_; }
  void set_last(std::optional<LastIncrement> last) { last_ = std::move(last); }

  /// @param now the state at time `from`, the last one remembered
  [[nodiscard]] std::optional<State> guess(const State &now, double from, double to);

  /// The state at a time if every body moves as its supports do in the mean.
  [[nodiscard]] State approach(const State &now, double to) const;
  /// Own nodes (contact, node) that are open and close on the way to `approach`. Collective.
  [[nodiscard]] std::vector<std::pair<int, Index>> touching(const State &now, const State &approach);

private:
  struct Loads
  {
    std::vector<double> displacement; ///< as in a state
    std::vector<double> force;        ///< nodal
    std::vector<double> on_rigid;     ///< forces on the rigid bodies' unknowns
  };
  [[nodiscard]] Loads loads(const State &state, double time);
  /// The factor by which the loads' change from `from` to `to` is the one from start to `from`, if it is one.
  [[nodiscard]] std::optional<double> load_ratio(const State &now, double from, double to);

  Model &model_;
  std::optional<LastIncrement> last_;
};
} // namespace amontons
