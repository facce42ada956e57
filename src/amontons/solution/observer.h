#pragma once
#include "amontons/base/timer.h"
#include "amontons/solution/checkpoint.h"

namespace amontons
{
/// Listens to a run. Calls come in this order: start, then per increment attempt begin, iteration..., and accepted or
/// rejected, after accepted perhaps checkpoint; at last finish. Every process calls the same ones for the observers it
/// has, in the same order; observers that take part in collective calls are to be on all.
class Observer
{
public:
  Observer() = default;
  Observer(const Observer &) = delete;
  Observer &operator=(const Observer &) = delete;
  virtual ~Observer() = default;

  /// @param n_dofs unknowns of displacement and multipliers
  virtual void start(const SolutionState & /*initial*/, std::int64_t /*n_dofs*/) {}
  virtual void begin_increment(int /*increment*/, double /*time*/, double /*time_step*/) {}
  virtual void iteration(const IterationReport & /*report*/) {}
  virtual void accepted(const IncrementReport & /*report*/, const SolutionState & /*state*/) {}
  virtual void rejected(const IncrementReport & /*report*/, const std::string & /*cause*/) {}
  /// Whether a checkpoint is to be handed over after an accepted increment. @param last of the run
  [[nodiscard]] virtual bool wants_checkpoint(int /*increment*/, bool /*last*/) const { return false; }
  /// @param checkpoint of the whole on process 0; of no use elsewhere
  virtual void checkpoint(const Checkpoint & /*checkpoint*/) {}
  /// Something the user should know that is no error.
  virtual void warning(const std::string & /*message*/) {}
  /// @param counters of all processes together @param failure empty when the run reached its end
  virtual void finish(const SolutionState & /*last*/, const Counters & /*counters*/, const Timers & /*timers*/,
                      const std::string & /*failure*/)
  {
  }
};
} // namespace amontons
