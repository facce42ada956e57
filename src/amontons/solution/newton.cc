#include "amontons/algebra/linear_solver_failure.h"
#include "amontons/solution/form_choice.h"
#include "amontons/solution/newton_iterate.h"

#include <limits>
#include <map>

namespace amontons
{
namespace
{
constexpr int max_halvings = 8;
/// Where the bodies are not linear a step that makes the residual grow by more than this is halved, so many times at
/// the most. Statuses that change may well make it grow for once; points that yield and unload in turn (two iterates
/// that lead to each other) are left behind where no growth at all is allowed.
constexpr double allowed_growth = 2;
constexpr int max_damping = 4;
/// Times a set of statuses may come back before the increment is given up.
constexpr int max_cycles = 6;
/// Iterations with half steps after a circle was found.
constexpr int damped_after_cycle = 3;
/// Part of the tolerance that a linear solve may leave, and the loosest one.
constexpr double linear_share = 0.3, loosest = 0.1;
/// Where no more than this part of the closed nodes changed status, the next solve is likely to be the last.
constexpr double few_changes = 0.01;
/// The loosest where prescribed motion is still to come.
constexpr double first_share = 1e-3;
/// Each iteration that does not bring the residual down by this makes the loosest tolerance smaller.
constexpr double progress = 0.5, tightening = 0.1;

/// Of the softest body's Young's modulus to the stiffest's. What a linear solve leaves of forces in a stiff body may be
/// more than all forces that a soft one bears, those of contact among them.
double softness(const ProblemOptions &options)
{
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const BodyOptions &body : options.bodies)
    if (body.material.young > 0)
    {
      least = std::min(least, body.material.young);
      most = std::max(most, body.material.young);
    }
  return most > 0 ? least / most : 1;
}
} // namespace

Newton::Newton(Model &model, LinearSolverType linear, Counters &counters, Timers &timers,
               std::function<void(const IterationReport &)> report)
  : model_(model)
  , counters_(counters)
  , earlier_(counters)
  , timers_(timers)
  , report_(std::move(report))
  , form_(make_form(model, linear))
  , contacts_(model, *form_)
  , free_motions_(model)
  , predictor_(model)
  , softness_(softness(model.options()))
{
  free_motions_.check_restrained();
  if (free_motions_.any())
    contacts_.record_nodes();
  contacts_.rebuild_pattern();
}

Newton::~Newton() = default;

void Newton::begin_increment(const State &start)
{
  bool changed = false;
  const std::vector<double> displacement = model_.with_halo(start.displacement);
  try
  {
    agree_on_failures(model_.nodes(),
                      [&]
                      {
                        for (ContactInterface &contact : model_.contacts())
                          changed |= contact.begin_increment(displacement, reach_);
                      });
  }
  catch (const NumericalFailure &)
  {
    contacts_.rebuild_pattern(); // some pairs may be back by now
    throw;
  }
  if (!model_.nodes().true_on_all(!changed))
    contacts_.rebuild_pattern();
}

bool Newton::detect(State &state)
{
  if (model_.small_strain())
    return false;
  const auto scope = timers_.measure("detection");
  counters_.n_detections += static_cast<std::int64_t>(model_.contacts().size());
  const std::vector<double> reaches(model_.contacts().size(), reach_);
  const int halo = model_.halo_version();
  bool changed = false;
  const auto take_over = [&]
  {
    if (model_.halo_version() != halo)
      form_->set_held_modes({}); // they are over the unknowns that there were
    contacts_.rebuild_pattern();
  };
  try
  {
    changed = model_.detect(state, reaches, true);
  }
  catch (const NumericalFailure &)
  {
    take_over();
    throw;
  }
  if (changed)
    take_over();
  return changed;
}

/// Of the right side's forces. As far as the residual that the change of statuses and the bodies' nonlinearity will
/// leave anyway (Eisenstat, Walker 1996), and whole once nothing but the linear system is left.
/// @param trial the solution tells nodes that close with friction where their slip starts
double Newton::linear_tolerance(const Evaluation &at, double last_norm, double forcing, bool settled, bool trial) const
{
  const double tolerance = linear_share * model_.options().solver.tolerance;
  const Sharing &unknowns = model_.layout().sharing();
  const auto forces = std::span(at.rhs).first(static_cast<std::size_t>(unknowns.size()));
  const double force = std::max(std::sqrt(unknowns.dot(forces, forces)), at.norm);
  // While the prescribed motion is to come, the right side is what it takes to move the supports' neighbours alone, and
  // the scale of forces is not known.
  if (at.pending_motion > 0)
    return settled || trial ? tolerance : std::max(tolerance, softness_ * first_share);
  const double enough = tolerance * at.scale / force;
  if (settled || trial)
    return enough;
  return std::max(enough, std::min(forcing, 0.9 * std::pow(at.norm / last_norm, 2)));
}

std::vector<double> Newton::solve_linear(const Evaluation &at, double tolerance)
{
  std::vector<double> step(at.rhs.size());
  {
    const auto scope = timers_.measure("linear_setup");
    form_->factorize();
  }
  const auto scope = timers_.measure("linear_solve");
  form_->solve(at.rhs, step, tolerance);
  const FormCounters cost = form_->counters();
  counters_.n_pattern_builds = earlier_.n_pattern_builds + cost.n_pattern_builds;
  counters_.n_factorizations = earlier_.n_factorizations + cost.n_factorizations;
  counters_.n_preconditioner_setups = earlier_.n_preconditioner_setups + cost.n_preconditioner_setups;
  counters_.n_linear_iterations = earlier_.n_linear_iterations + cost.n_iterations;
  const bool finite = std::all_of(step.begin(), step.end(), [](double x) { return std::isfinite(x); });
  if (!model_.nodes().true_on_all(finite))
    throw NumericalFailure("the tangent matrix is singular");
  return step;
}

bool Newton::runs_away(const Evaluation &from, const Evaluation &next) const
{
  if (model_.tangent_is_constant() || from.pending_motion > 0)
    return false;
  const bool plastic_only = model_.small_strain() && next.signature == from.signature;
  return next.norm > (plastic_only ? 1 : allowed_growth) * from.norm;
}

Newton::Iterate Newton::step_from(const Iterate &from, const State &start, double time, const Step &step, bool damp,
                                  double &share)
{
  Iterate next;
  share = damp ? 0.5 : 1;
  for (int k = 0; k <= max_halvings; ++k, share *= 0.5)
  {
    next.state = model_.prescribe(model_.advance(from.state, step, share), time, share);
    detect(next.state);
    next.at = evaluate(next.state, start, time, {}, false);
    if (next.at.valid && (k >= max_damping || !runs_away(from.at, next.at)))
      return next;
  }
  throw NumericalFailure("a cell turns inside out");
}

void Newton::set_trial(const State &trial, const State &start)
{
  const std::vector<double> now = model_.with_halo(trial.displacement), then = model_.with_halo(start.displacement);
  bool changed = false;
  agree_on_failures(model_.nodes(),
                    [&]
                    {
                      for (ContactInterface &contact : model_.contacts())
                        changed |= contact.set_trial(now, then);
                    });
  if (!model_.nodes().true_on_all(!changed))
    contacts_.rebuild_pattern();
}

void Newton::iterate(Iterate &now, const State &start, double time, NewtonOutcome &outcome)
{
  const SolverOptions &options = model_.options().solver;
  std::map<std::uint64_t, int> seen;
  int n_cycles = 0;
  int n_damped = 0;
  double last_norm = now.at.norm, forcing = softness_ * loosest;
  const auto contacts = std::span(std::as_const(model_).contacts());
  bool settled = std::all_of(contacts.begin(), contacts.end(), [](const auto &c) { return c.options().tied; });
  for (int iteration = 1; now.at.norm > options.tolerance * now.at.scale || now.at.pending_motion > 0; ++iteration)
  {
    if (iteration > options.max_iterations)
      throw NumericalFailure("no convergence in " + std::to_string(options.max_iterations) + " iterations");
    contacts_.remember_slip();
    restrain(now.at, now.state, start, time, iteration == 1 && !now.has_trial);
    const auto n_before = form_->counters().n_iterations;
    const Step step = model_.step_of(solve_linear(
        now.at, linear_tolerance(now.at, last_norm, forcing, settled, !now.has_trial && model_.has_friction())));
    outcome.n_iterations = iteration;
    outcome.n_linear_iterations += static_cast<int>(form_->counters().n_iterations - n_before);
    ++counters_.n_newton_iterations;

    double share = 1;
    Iterate next = step_from(now, start, time, step, n_damped > 0, share);
    if (!now.has_trial)
      set_trial(next.state, start);
    next.has_trial = true;
    IterationReport report = compare(now, next);
    report.iteration = iteration;
    report.step_length = share;
    // A set of statuses and faces that comes back after others: the iterations turn in a circle.
    const auto [place, is_new] = seen.try_emplace(next.at.signature, iteration);
    const bool circle = !is_new && next.at.signature != now.at.signature;
    n_damped = circle ? damped_after_cycle : std::max(n_damped - 1, 0);
    place->second = iteration;
    n_cycles += circle;
    report_(report);
    // While prescribed motion was to come, the residual said nothing of the forces.
    last_norm = now.at.pending_motion > 0 ? next.at.norm : now.at.norm;
    if (now.at.pending_motion == 0 && next.at.norm > progress * now.at.norm)
      forcing *= tightening;
    settled = model_.tangent_is_constant() && report.n_status_changes <= few_changes * report.n_active;
    now = std::move(next);
    if (n_cycles > max_cycles)
      throw NumericalFailure("statuses or faces turn in a circle" +
                             (report.remark.empty() ? "" : ": " + report.remark));
  }
}

bool Newton::nothing_closed() const
{
  bool closed = false;
  for (const ContactInterface &contact : std::as_const(model_).contacts())
    for (Index i = 0; i < contact.n_nodes(); ++i)
      closed |= contact.committed_status(i) != ContactStatus::open;
  return model_.nodes().true_on_all(!closed);
}

Newton::Iterate Newton::begin(const State &start, double time, const State *guess)
{
  form_->set_held_modes({});
  contacts_.forget_slip();
  Iterate out;
  out.state = guess ? *guess : predictor_.carried(start, time);
  detect(out.state);
  Closed touching;
  // FreeMotions chooses by itself what closes first where forces move bodies.
  if (!guess && !free_motions_.any() && (!model_.has_friction() || nothing_closed()))
  {
    const State approach = predictor_.approach(start, time);
    touching = predictor_.touching(start, approach);
    out.has_trial = !model_.nodes().true_on_all(touching.empty());
    if (out.has_trial)
      set_trial(approach, start);
  }
  out.at = evaluate(out.state, start, time, touching, !guess);
  if (guess && out.at.valid)
  {
    set_trial(out.state, start);
    out.has_trial = true;
  }
  return out;
}

void Newton::attempt(State &state, const State &start, double to, const State *guess, NewtonOutcome &outcome)
{
  Iterate now = begin(start, to, guess);
  if (!now.at.valid)
    throw NumericalFailure("a cell is inside out at the beginning of the increment");
  n_flips_.assign(now.at.status.size(), 0);
  iterate(now, start, to, outcome);
  outcome.converged = true;
  residual_ = now.at.residual;
  state = std::move(now.state);
}

NewtonOutcome Newton::solve(State &state, double from, double to, double reach)
{
  reach_ = reach;
  NewtonOutcome outcome;
  const State start = state;
  const std::optional<State> guess = predictor_.guess(start, from, to);
  std::vector<const State *> beginnings{nullptr};
  // Where nodes slide with friction from face to face a guess may lead to another solution (ironing would end in a
  // fold): it is the second try there.
  if (guess)
    beginnings.insert(model_.small_strain() || !model_.has_friction() ? beginnings.begin() : beginnings.end(), &*guess);
  for (const State *beginning : beginnings)
    try
    {
      begin_increment(start);
      attempt(state, start, to, beginning, outcome);
      predictor_.set_last(LastIncrement{start, from, to});
      break;
    }
    catch (const NumericalFailure &failure)
    {
      outcome.cause = failure.what();
      outcome.linear_solver_failed |= dynamic_cast<const LinearSolverFailure *>(&failure) != nullptr;
    }
  return outcome;
}
} // namespace amontons
