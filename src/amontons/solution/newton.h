#pragma once
#include "amontons/algebra/system_form.h"
#include "amontons/base/timer.h"
#include "amontons/solution/contact_assembly.h"
#include "amontons/solution/free_motions.h"
#include "amontons/solution/model.h"
#include "amontons/solution/observer.h"
#include "amontons/solution/predictor.h"

#include <functional>
#include <string>

namespace amontons
{
/// How an attempt at an increment ended.
struct NewtonOutcome
{
  bool converged = false;
  std::string cause; ///< of failure
  bool linear_solver_failed = false;
  int n_iterations = 0;
  int n_linear_iterations = 0;
};

/// Semismooth Newton method for G(x) + F(x, lambda) = 0 over one increment: statuses are decided by sigma at each
/// iteration (Alart, Curnier 1991). Full steps; a step is halved only where a cell would turn inside out, where the
/// residual of bodies that are not linear would run away, or to leave a cycle of statuses. Converged when the residual,
/// with r F_lambda for the constraints, is below the tolerance times the forces present.
class Newton
{
public:
  /// @param linear see make_form() @param counters are counted on
  Newton(Model &model, LinearSolverType linear, Counters &counters, Timers &timers,
         std::function<void(const IterationReport &)> report);
  ~Newton();

  /// Moves `state` from its equilibrium at time `from` to the one at `to`. On failure `state` is left as it was.
  /// @param reach see Detector
  NewtonOutcome solve(State &state, double from, double to, double reach);

  /// Residual at a converged state, nodal: reactions at held components. [n_nodal]
  [[nodiscard]] const std::vector<double> &residual() const { return residual_; }

  /// From which the next increment's end is guessed; empty at first.
  [[nodiscard]] const std::optional<LastIncrement> &last_increment() const { return predictor_.last(); }
  void set_last_increment(std::optional<LastIncrement> last) { predictor_.set_last(std::move(last)); }

private:
  struct Evaluation;
  struct Iterate;
  [[nodiscard]] Evaluation evaluate(const State &state, const State &start, double time,
                                    std::span<const std::pair<int, Index>> forced, bool first);
  void compute_residual(Evaluation &out, const State &state, double time, const ContactContribution &contact) const;
  /// Puts back what a failed attempt left, and starts the slip.
  void begin_increment(const State &start);
  bool detect(State &state);
  void prepare_matrix(const State &state, double time);
  [[nodiscard]] std::vector<double> solve_linear(const Evaluation &at, double tolerance);
  [[nodiscard]] double linear_tolerance(const Evaluation &at, double last_norm, double forcing, bool settled,
                                        bool trial) const;
  void set_trial(const State &trial, const State &start);
  [[nodiscard]] bool nothing_closed() const;
  /// The state and its evaluation from which an increment's iterations start.
  [[nodiscard]] Iterate begin(const State &start, double time, const State *guess);
  /// Solves for `state` from a guess, or from the increment's beginning. @throws NumericalFailure with the cause
  void attempt(State &state, const State &start, double to, const State *guess, NewtonOutcome &outcome);
  /// Newton's iterations from `now` to the solution, which replaces it. @throws NumericalFailure with the cause
  void iterate(Iterate &now, const State &start, double time, NewtonOutcome &outcome);
  [[nodiscard]] bool runs_away(const Evaluation &from, const Evaluation &next) const;
  [[nodiscard]] Iterate step_from(const Iterate &from, const State &start, double time, const Step &step, bool damp,
                                  double &share);
  [[nodiscard]] IterationReport compare(const Iterate &before, const Iterate &after);
  void restrain(Evaluation &at, const State &state, const State &start, double time, bool first);
  void update_rigid_blocks(const State &state, std::span<const double> contact_force);
  [[nodiscard]] std::string face_remark() const;
  [[nodiscard]] std::string remark(const Evaluation &now, std::span<const ContactStatus> before);

  Model &model_;
  Counters &counters_;
  const Counters earlier_; ///< than this one
  Timers &timers_;
  std::function<void(const IterationReport &)> report_;
  std::unique_ptr<SystemForm> form_;
  ContactAssembly contacts_;
  FreeMotions free_motions_;
  Predictor predictor_;
  const double softness_; ///< see linear_tolerance()
  double reach_ = 0;
  bool tangent_assembled_ = false;
  std::vector<double> residual_;
  std::vector<double> diagonal_; ///< see diagonal_stiffness(), of the present tangent
  std::vector<int> n_flips_;     ///< of each own contact node's status within the increment
};
} // namespace amontons
