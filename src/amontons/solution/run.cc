#include "amontons/solution/run.h"

#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/base/error.h"
#include "amontons/parallel/agreement.h"
#include "amontons/solution/form_choice.h"
#include "amontons/solution/given_motions.h"
#include "amontons/solution/newton.h"
#include "amontons/solution/start.h"

#include <algorithm>
#include <cmath>

namespace amontons
{
namespace
{
constexpr double cut_factor = 0.5;
constexpr double growth_factor = 1.5;
/// An increment that took no more iterations lets the next one grow.
constexpr int easy_iterations = 6;
constexpr double default_min_increment = 1e-4;

const char *name_of(LinearSolverType linear)
{
  switch (linear)
  {
  case LinearSolverType::direct:
    return "direct";
  case LinearSolverType::amg:
    return "amg";
  case LinearSolverType::feti:
    return "feti";
  case LinearSolverType::automatic:
    break;
  }
  return "auto";
}

/// A run under way.
class Run
{
public:
  Run(const ProblemOptions &options, std::span<Observer *const> observers, const Checkpoint *from,
      const Communicator &communicator)
    : observers_(observers)
  {
    {
      const auto scope = timers_.measure("mesh");
      model_ = std::make_unique<Model>(
          options, communicator.size() > 1 ? std::make_shared<MessageExchange>(communicator) : nullptr);
    }
    const auto scope = timers_.measure("setup");
    given_ = std::make_unique<GivenMotions>(*model_);
    state_ = model_->initial_state();
    if (!model_->nodes().true_on_all(model_->bodies().assemble_tangent(model_->mesh_part(state_.displacement), 0)))
      throw InternalError("a cell is inside out at the start");
    set_augmentation(*model_, diagonal_stiffness(*model_));
    detect_first(*model_, state_);
    counters_.n_detections += static_cast<std::int64_t>(model_->contacts().size());
    step_ = std::min(model_->options().loading.end / model_->options().loading.increments, most_step());
    solvers_ = linear_solvers(model_->options(), model_->mesh());
    if (from)
      restore(own_part(*from));
    else
      take_next_solver();
  }

  RunResult solve()
  {
    SolutionState last = solution({});
    tell(&Observer::start, last, static_cast<std::int64_t>(model_->n_global_unknowns()));
    if (increment_ == 0)
      for (const std::string &warning : initial_warnings(*model_))
        tell(&Observer::warning, warning);
    const LoadingOptions &loading = model_->options().loading;
    std::string failure;
    for (int cutbacks = 0; time_ < loading.end;)
    {
      double to = time_ + step_;
      if (to > loading.end - 1e-9 * loading.end)
        to = loading.end;
      const double length = to - time_;
      tell(&Observer::begin_increment, increment_ + 1, to, length);
      State next = state_;
      const NewtonOutcome outcome = newton_->solve(next, time_, to, reach(time_, to));
      const IncrementReport report{to, length, outcome.n_iterations, outcome.n_linear_iterations, cutbacks};
      if (!outcome.converged)
      {
        tell(&Observer::rejected, report, outcome.cause);
        if (outcome.linear_solver_failed && !solvers_.empty())
        {
          tell(&Observer::warning, outcome.cause + "; 'linear: " + name_of(solvers_.front()) + "' takes over");
          take_next_solver();
          continue;
        }
        ++cutbacks;
        step_ = cut_factor * length;
        if (loading.fixed || step_ < least_step())
        {
          failure = "increment " + std::to_string(increment_ + 1) + " (t = " + std::to_string(time_) + " to " +
                    std::to_string(to) + "): " + outcome.cause;
          break;
        }
        continue;
      }
      last = accept(next, to);
      tell(&Observer::accepted, report, last);
      if (!loading.fixed && outcome.n_iterations <= easy_iterations)
        step_ = std::min(most_step(), growth_factor * step_);
      cutbacks = 0;
      hand_over_checkpoint(time_ >= loading.end);
    }
    if (!failure.empty() && increment_ > 0)
      hand_over_checkpoint(true);
    tell(&Observer::finish, last, counters_of_all(), timers_, failure);
    return {failure.empty(), failure};
  }

private:
  template<class... Parameters, class... Arguments>
  void tell(void (Observer::*event)(Parameters...), const Arguments &...arguments)
  {
    const auto scope = timers_.measure("output");
    for (Observer *observer : observers_)
      (observer->*event)(arguments...);
  }

  [[nodiscard]] double most_step() const
  {
    const LoadingOptions &loading = model_->options().loading;
    return loading.max_increment.value_or(loading.end / loading.increments);
  }

  [[nodiscard]] double least_step() const
  {
    const LoadingOptions &loading = model_->options().loading;
    return loading.min_increment.value_or(default_min_increment * loading.end / loading.increments);
  }

  [[nodiscard]] Checkpoint own_part(const Checkpoint &whole) const
  {
    std::vector<std::vector<GlobalIndex>> contact_nodes;
    for (const ContactInterface &contact : model_->contacts())
      contact_nodes.push_back(contact.history().nodes);
    return part_of(whole, model_->problem_key(), model_->mesh(), model_->nodes(), model_->n_state_nodes(),
                   contact_nodes);
  }

  /// @param from this process's part
  void restore(const Checkpoint &from)
  {
    AMONTONS_ASSERT(from.state.displacement.size() == state_.displacement.size() &&
                    from.state.multipliers.size() == state_.multipliers.size() &&
                    from.state.rigid.size() == state_.rigid.size() &&
                    from.contacts.size() == model_->contacts().size());
    if (from.time >= model_->options().loading.end)
      throw UserError("the checkpoint is of t = " + std::to_string(from.time) +
                      ", the end of the run: for a longer "
                      "one, set loading.end (and loading.increments, for the same steps)");
    state_ = start_ = from.state;
    time_ = from.time;
    increment_ = from.increment;
    step_ = model_->options().loading.fixed ? most_step() : std::clamp(from.next_step, least_step(), most_step());
    last_motion_ = from.last_motion;
    counters_ = from.counters;
    for (std::size_t c = 0; c < from.contacts.size(); ++c)
      model_->contacts()[c].set_history(from.contacts[c]);
    model_->update_halo();
    model_->bodies().set_histories(from.cells);
    model_->update_layout(state_);
    if (const auto solver = std::find(solvers_.begin(), solvers_.end(), from.linear_solver); solver != solvers_.end())
      solvers_.erase(solvers_.begin(), solver); // those before it have failed
    take_next_solver();
    newton_->set_last_increment(from.last);
  }

  /// Everything else is counted by all processes alike.
  [[nodiscard]] Counters counters_of_all() const
  {
    Counters out = counters_;
    auto n = static_cast<double>(out.n_factorizations);
    model_->nodes().sum_over_processes({&n, 1});
    out.n_factorizations = static_cast<std::int64_t>(n);
    return out;
  }

  void hand_over_checkpoint(bool last)
  {
    std::optional<Checkpoint> checkpoint;
    for (Observer *observer : observers_)
    {
      if (!observer->wants_checkpoint(increment_, last))
        continue;
      const auto scope = timers_.measure("output");
      if (!checkpoint)
        checkpoint = gathered(local_checkpoint(), model_->mesh(), model_->nodes());
      observer->checkpoint(*checkpoint);
    }
  }

  [[nodiscard]] Checkpoint local_checkpoint() const
  {
    Checkpoint out{model_->problem_key(),
                   increment_,
                   time_,
                   step_,
                   last_motion_,
                   solver_,
                   state_,
                   newton_->last_increment(),
                   {},
                   model_->bodies().histories(),
                   counters_of_all()};
    for (const ContactInterface &contact : model_->contacts())
      out.contacts.push_back(contact.history());
    return out;
  }

  void take_next_solver()
  {
    std::optional<LastIncrement> last;
    if (newton_)
      last = newton_->last_increment();
    solver_ = solvers_.front();
    newton_ = std::make_unique<Newton>(*model_, solver_, counters_, timers_,
                                       [this](const IterationReport &r) { tell(&Observer::iteration, r); });
    newton_->set_last_increment(std::move(last));
    solvers_.erase(solvers_.begin());
  }

  /// How far any node of any process goes from one state to another.
  [[nodiscard]] double largest_motion(const State &from, const State &to) const
  {
    double largest2 = 0;
    const int dim = model_->dim();
    for (std::size_t i = 0; i < to.displacement.size(); i += dim)
    {
      double way2 = 0;
      for (int c = 0; c < dim; ++c)
        way2 += std::pow(to.displacement[i + c] - from.displacement[i + c], 2);
      largest2 = std::max(largest2, way2);
    }
    return std::sqrt(model_->nodes().maximum_over_processes(largest2));
  }

  /// Twice the largest motion expected from the present state until a time, as the observer sees it.
  [[nodiscard]] double reach(double from, double to) const
  {
    const State carried = given_->moved(state_, given_->of_observer(state_, model_->prescribe(state_, to, 1)));
    double reach = 2 * std::max(largest_motion(carried, model_->prescribe(carried, to, 1)), last_motion_);
    if (from == 0 || last_motion_ == 0)
      for (const ContactInterface &contact : model_->contacts())
        reach = std::max(reach, 2 * separation_and_extent(*model_, contact).first);
    return reach;
  }

  [[nodiscard]] SolutionState solution(std::vector<Reaction> reactions)
  {
    SolutionState out;
    out.mesh = &model_->mesh();
    out.nodes = &model_->nodes();
    out.time = time_;
    out.increment = increment_;
    const auto u = model_->mesh_part(state_.displacement);
    out.displacement.assign(u.begin(), u.end());
    out.stress = model_->bodies().stress(u);
    out.plastic_strain = model_->bodies().plastic_strain();
    const State &start = increment_ > 0 ? start_ : state_;
    const std::vector<double> now = model_->with_halo(state_.displacement),
                              then = model_->with_halo(start.displacement);
    agree_on_failures(model_->nodes(),
                      [&]
                      {
                        for (ContactInterface &contact : model_->contacts())
                          out.contacts.push_back(contact.result(now, then, state_.multipliers));
                      });
    for (std::size_t c = 0; c < out.contacts.size(); ++c)
      complete(out.contacts[c], model_->contacts()[c].surfaces().sharing);
    out.reactions = std::move(reactions);
    return out;
  }

  SolutionState accept(State &next, double time)
  {
    last_motion_ = largest_motion(given_->moved(state_, given_->of_observer(state_, next)), next);
    start_ = std::move(state_);
    state_ = std::move(next);
    time_ = time;
    ++increment_;
    model_->bodies().commit(model_->mesh_part(state_.displacement));
    SolutionState out = solution(model_->reactions(newton_->residual()));
    for (std::size_t c = 0; c < out.contacts.size(); ++c)
      model_->contacts()[c].commit(out.contacts[c]);
    return out;
  }

  std::span<Observer *const> observers_;
  Timers timers_;
  Counters counters_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<GivenMotions> given_;
  std::unique_ptr<Newton> newton_;
  LinearSolverType solver_ = LinearSolverType::automatic; ///< that is at work
  std::vector<LinearSolverType> solvers_;                 ///< that may yet be taken
  State state_, start_;
  int increment_ = 0; ///< the last converged one
  double time_ = 0;   ///< at its end
  double step_ = 0;   ///< length of the next
  double last_motion_ = 0;
};
} // namespace

RunResult run(const ProblemOptions &options, std::span<Observer *const> observers, const Checkpoint *from,
              const Communicator &communicator)
{
  std::optional<Run> run; // outlives a failure of one process: its destruction is collective
  RunResult result;
  end_together(communicator,
               [&]
               {
                 run.emplace(options, observers, from, communicator);
                 result = run->solve();
               });
  return result;
}

ProblemCheck check_problem(const ProblemOptions &options)
{
  Model model(options);
  FreeMotions(model).check_restrained();
  State state = model.initial_state();
  detect_first(model, state);
  ProblemCheck out;
  out.n_nodes = model.mesh().n_nodes();
  out.n_cells = model.mesh().cells.size();
  out.n_dofs = model.n_global_unknowns();
  for (std::size_t c = 0; c < model.contacts().size(); ++c)
  {
    const ContactInterface &contact = model.contacts()[c];
    out.contacts.push_back({contact.options().name, contact.n_nodes(),
                            contact.target() ? contact.target()->n_faces() : 0, model.detection_report(c)});
  }
  out.warnings = initial_warnings(model);
  return out;
}
} // namespace amontons
