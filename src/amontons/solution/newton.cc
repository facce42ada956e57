#include "amontons/solution/newton.h"

#include "amontons/solution/form_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace amontons
{
namespace
{
constexpr int max_halvings = 8;
/// In finite strain a step that makes the residual grow by more than this is halved, so many times at the most.
/// Statuses that change may well make it grow for once.
constexpr double allowed_growth = 2;
constexpr int max_damping = 4;
/// Times a set of statuses may come back before the increment is given up.
constexpr int max_cycles = 6;
/// Iterations with half steps after a circle was found.
constexpr int damped_after_cycle = 3;
/// A node that changed its status so often within an increment is named.
constexpr int named_flips = 3;
/// Part of the tolerance that a linear solve may leave, and the loosest one.
constexpr double linear_share = 0.3, loosest = 0.1;
/// Where no more than this part of the closed nodes changed status, the next solve is likely to be the last.
constexpr double few_changes = 0.01;
/// The loosest where prescribed motion is still to come.
constexpr double first_share = 1e-3;
/// Of the internal forces, over what the displacement would meet if nodes moved alone.
constexpr double round_off = 1e-13;

const char *name(ContactStatus status)
{
  return status == ContactStatus::open ? "open" : status == ContactStatus::stick ? "stick" : "slip";
}

double norm2(std::span<const double> v)
{
  double sum = 0;
  for (const double x : v)
    sum += x * x;
  return sum;
}

double largest(std::span<const double> v)
{
  double out = 0;
  for (const double x : v)
    out = std::max(out, std::abs(x));
  return out;
}

/// Forces that a displacement meets at the nodes' own stiffness: round-off in the internal forces is a part of them.
double resisted_force(std::span<const SubdomainMatrix> subdomains, std::span<const double> displacement)
{
  double sum = 0;
  for (const SubdomainMatrix &matrix : subdomains)
    for (Index row = 0; row < matrix.n_rows(); ++row)
    {
      const auto begin = matrix.col.begin() + matrix.row_ptr[row], end = matrix.col.begin() + matrix.row_ptr[row + 1];
      const auto diagonal = std::lower_bound(begin, end, row) - matrix.col.begin();
      const auto nodal = static_cast<std::size_t>(matrix.nodes[row / matrix.n_components]) * matrix.n_components +
                         row % matrix.n_components;
      sum += std::pow(matrix.values[diagonal] * displacement[nodal], 2);
    }
  return std::sqrt(sum);
}

/// Identifies a set of statuses and faces (FNV-1a).
std::uint64_t signature(std::span<const ContactStatus> statuses, std::span<const ContactInterface> contacts)
{
  std::uint64_t hash = 14695981039346656037ull;
  const auto mix = [&](std::int64_t value) { hash = (hash ^ static_cast<std::uint64_t>(value)) * 1099511628211ull; };
  for (const ContactStatus status : statuses)
    mix(static_cast<std::int64_t>(status));
  for (const ContactInterface &contact : contacts)
    for (const Pair &pair : contact.pairing())
      mix(pair.face);
  return hash;
}

bool has_friction(const Model &model)
{
  const auto &contacts = model.contacts();
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const auto &c) { return c.options().friction_coefficient > 0; });
}
} // namespace

using Closed = std::vector<std::pair<int, Index>>;

/// The residual at a state, and what is needed to go on from it.
struct Newton::Evaluation
{
  bool valid = false;
  std::vector<double> pending;  ///< prescribed motion still to come, nodal
  std::vector<double> residual; ///< internal - external + contact, nodal
  std::vector<double> rhs;      ///< minus the residual, over the unknowns, prescribed motion included
  std::vector<ContactStatus> status;
  std::uint64_t signature = 0; ///< of statuses and faces
  double norm = 0, scale = 0;  ///< force
  double pending_motion = 0;   ///< length
};

struct Newton::Iterate
{
  bool has_trial = false; ///< nodes that close know where their slip starts
  State state;
  Evaluation at;
};

Newton::Newton(Model &model, Counters &counters, Timers &timers, std::function<void(const IterationReport &)> report)
  : model_(model)
  , counters_(counters)
  , timers_(timers)
  , report_(std::move(report))
  , form_(make_form(model))
  , contacts_(model, *form_)
  , free_motions_(model)
  , predictor_(model)
{
  free_motions_.check_restrained();
  if (free_motions_.any())
    contacts_.record_nodes();
  contacts_.rebuild_pattern();
}

Newton::~Newton() = default;

void Newton::begin_increment(const State &state, double reach)
{
  reach_ = reach;
  bool restored = false;
  for (ContactInterface &contact : model_.contacts())
    restored |= contact.begin_increment(state.displacement);
  if (restored)
    contacts_.rebuild_pattern();
}

bool Newton::detect(State &state)
{
  if (model_.small_strain())
    return false;
  const auto scope = timers_.measure("detection");
  bool changed = false;
  for (ContactInterface &contact : model_.contacts())
  {
    ++counters_.n_detections;
    if (!contact.detect(state.displacement, reach_, true))
      continue;
    changed = true;
    contact.turn_multipliers(state.displacement, state.multipliers);
  }
  if (changed)
    contacts_.rebuild_pattern();
  return changed;
}

void Newton::prepare_matrix(const State &state, double time)
{
  const auto scope = timers_.measure("bulk_assembly");
  model_.update_layout(state);
  bool fresh = form_->prepare();
  if (!tangent_assembled_ || !model_.bodies().tangent_is_constant())
  {
    if (!model_.bodies().assemble_tangent(model_.mesh_part(state.displacement), time))
      throw NumericalFailure("a cell turned inside out");
    ++counters_.n_bulk_assemblies;
    tangent_assembled_ = true;
    fresh = true;
  }
  if (fresh)
    form_->update_subdomains();
}

void Newton::compute_residual(Evaluation &out, const State &state, double time,
                              const ContactContribution &contact) const
{
  std::vector<double> internal(out.pending.size(), 0.0), external(out.pending.size(), 0.0);
  out.valid = model_.bodies().forces(model_.mesh_part(state.displacement), time, model_.mesh_part(internal),
                                     model_.mesh_part(external));
  out.residual.resize(internal.size());
  for (std::size_t i = 0; i < internal.size(); ++i)
    out.residual[i] = internal[i] - external[i] + contact.force[i];

  const Layout &layout = model_.layout();
  std::vector<double> forces(static_cast<std::size_t>(layout.n_unknowns()), 0.0), with_pending(out.residual);
  std::vector<double> rigid(static_cast<std::size_t>(model_.rigid().n_unknowns()), 0.0);
  model_.rigid().add_forces(time, rigid);
  layout.gather(out.residual, forces);
  for (std::size_t i = 0; i < rigid.size(); ++i)
    forces[i] -= rigid[i];
  out.norm = std::sqrt(norm2({forces.data(), static_cast<std::size_t>(layout.n_displacement_unknowns())}) +
                       contact.constraint_norm2);
  out.scale = std::sqrt(std::max({norm2(internal), norm2(external), contact.force_norm2, norm2(rigid)}));
  // Bodies that travel freely bear no force but round-off.
  out.scale = std::max(out.scale, round_off / model_.options().solver.tolerance *
                                      resisted_force(model_.bodies().subdomains(), state.displacement));
  if (!std::isfinite(out.norm))
    out.valid = false;

  if (out.pending_motion > 0)
  {
    for (const SubdomainMatrix &matrix : model_.bodies().subdomains())
      multiply_add(matrix, out.pending, with_pending);
    for (std::size_t i = 0; i < with_pending.size(); ++i)
      with_pending[i] += contact.prescribed_force[i];
  }
  out.rhs.assign(forces.size(), 0.0);
  layout.gather(with_pending, out.rhs);
  for (std::size_t i = 0; i < rigid.size(); ++i)
    out.rhs[i] -= rigid[i];
  for (Index m = 0; m < layout.n_multipliers(); ++m)
    out.rhs[layout.multiplier(m)] = contact.constraint[m] + contact.prescribed_gap[m];
  for (double &value : out.rhs)
    value = -value;
}

Newton::Evaluation Newton::evaluate(const State &state, const State &start, double time,
                                    std::span<const std::pair<int, Index>> forced, bool first)
{
  Evaluation out;
  try
  {
    prepare_matrix(state, time);
  }
  catch (const NumericalFailure &)
  {
    return out;
  }
  const State target = model_.prescribe(state, time, 1);
  out.pending.resize(state.displacement.size());
  for (std::size_t i = 0; i < out.pending.size(); ++i)
    out.pending[i] = target.displacement[i] - state.displacement[i];
  out.pending_motion = largest(out.pending);

  const auto scope = timers_.measure("contact_assembly");
  ++counters_.n_contact_updates;
  const ContactContribution contact = contacts_.evaluate(
      state, start.displacement,
      out.pending_motion > 0 ? std::span<const double>(out.pending) : std::span<const double>{}, forced, first);
  out.status = contact.status;
  out.signature = signature(out.status, model_.contacts());
  update_rigid_blocks(state, contact.force);
  compute_residual(out, state, time, contact);
  return out;
}

/// Second derivative of the places of a rigid body's nodes in its spins, times the contact forces on them:
/// delta theta . (r f^T - (r . f) I) Delta theta for spins added one after the other.
void Newton::update_rigid_blocks(const State &state, std::span<const double> contact_force)
{
  const int dim = model_.dim();
  const auto bodies = model_.rigid().bodies();
  for (std::size_t b = 0; b < bodies.size(); ++b)
  {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    if (!model_.small_strain())
      for (const Index node : bodies[b].nodes)
      {
        Eigen::Vector3d f = Eigen::Vector3d::Zero();
        for (int c = 0; c < dim; ++c)
          f[c] = contact_force[static_cast<std::size_t>(node) * dim + c];
        const Eigen::Vector3d arm = state.rigid[b].rotation * (model_.reference(node) - bodies[b].point);
        moment += arm * f.transpose() - arm.dot(f) * Eigen::Matrix3d::Identity();
      }
    std::vector<int> axes;
    for (int axis = 0; axis < 3; ++axis)
      if (bodies[b].rotation[axis].unknown >= 0)
        axes.push_back(axis);
    form_->update_dense_block(b, moment(axes, axes));
  }
}

void Newton::restrain(Evaluation &at, const State &state, const State &start, double time, bool first)
{
  if (!free_motions_.any())
    return;
  const FreeMotions::Decision decision =
      free_motions_.decide(state, contacts_.holding(), contacts_.candidates(), at.residual, time, at.scale);
  const bool bordered = form_->set_held_modes(decision.held_modes);
  if (!decision.closed.empty() || bordered)
    at = evaluate(state, start, time, decision.closed, first);
}

/// Of the right side's forces. As far as the residual that the change of statuses and the bodies' nonlinearity will
/// leave anyway (Eisenstat, Walker 1996), and whole once nothing but the linear system is left.
/// @param trial the solution tells nodes that close with friction where their slip starts
double Newton::linear_tolerance(const Evaluation &at, double last_norm, bool settled, bool trial) const
{
  const double tolerance = linear_share * model_.options().solver.tolerance;
  const auto n = static_cast<std::size_t>(model_.layout().n_displacement_unknowns());
  const double force = std::max(std::sqrt(norm2({at.rhs.data(), n})), at.norm);
  // While the prescribed motion is to come, the right side is what it takes to move the supports' neighbours alone, and
  // the scale of forces is not known.
  if (at.pending_motion > 0)
    return settled || trial ? tolerance : first_share;
  const double enough = tolerance * at.scale / force;
  if (settled || trial)
    return enough;
  return std::max(enough, std::min(loosest, 0.9 * std::pow(at.norm / last_norm, 2)));
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
  counters_.n_pattern_builds = cost.n_pattern_builds;
  counters_.n_factorizations = cost.n_factorizations;
  counters_.n_preconditioner_setups = cost.n_preconditioner_setups;
  counters_.n_linear_iterations = cost.n_iterations;
  for (const double x : step)
    if (!std::isfinite(x))
      throw NumericalFailure("the tangent matrix is singular");
  return step;
}

std::string Newton::remark(const Evaluation &now, std::span<const ContactStatus> before)
{
  std::size_t worst = now.status.size();
  for (std::size_t k = 0; k < now.status.size(); ++k)
    if (now.status[k] != before[k])
    {
      ++n_flips_[k];
      if (n_flips_[k] >= named_flips && (worst == now.status.size() || n_flips_[k] > n_flips_[worst]))
        worst = k;
    }
  if (worst == now.status.size())
    return face_remark();
  std::size_t first = 0;
  for (const ContactInterface &contact : model_.contacts())
  {
    if (worst < first + static_cast<std::size_t>(contact.n_nodes()))
    {
      const GlobalIndex node = contact.impactor().node_ids[worst - first];
      return "node " + std::to_string(model_.mesh().node_tags[static_cast<std::size_t>(node)]) + " " +
             name(before[worst]) + "<->" + name(now.status[worst]) + ", change " + std::to_string(n_flips_[worst]);
    }
    first += static_cast<std::size_t>(contact.n_nodes());
  }
  return "";
}

/// The node that has changed its face most often within the increment, if that is often.
std::string Newton::face_remark() const
{
  int most = named_flips - 1;
  GlobalIndex node = -1;
  for (const ContactInterface &contact : model_.contacts())
    for (Index i = 0; i < contact.n_nodes(); ++i)
      if (contact.n_face_changes(i) > most)
      {
        most = contact.n_face_changes(i);
        node = contact.impactor().node_ids[i];
      }
  if (node < 0)
    return "";
  return "node " + std::to_string(model_.mesh().node_tags[static_cast<std::size_t>(node)]) +
         " goes to another face, change " + std::to_string(most);
}

Newton::Iterate Newton::step_from(const Iterate &from, const State &start, double time,
                                  std::span<const double> increment, bool damp, double &share)
{
  Iterate next;
  share = damp ? 0.5 : 1;
  for (int k = 0; k <= max_halvings; ++k, share *= 0.5)
  {
    next.state = model_.prescribe(model_.advance(from.state, increment, share), time, share);
    detect(next.state);
    next.at = evaluate(next.state, start, time, {}, false);
    const bool wild = !model_.small_strain() && from.at.pending_motion == 0 && k < max_damping &&
                      next.at.norm > allowed_growth * from.at.norm;
    if (next.at.valid && !wild)
      return next;
  }
  throw NumericalFailure("a cell turns inside out");
}

IterationReport Newton::compare(const Iterate &before, const Iterate &after)
{
  IterationReport report;
  report.residual = after.at.scale > 0 ? after.at.norm / after.at.scale : after.at.norm;
  double change = 0;
  for (std::size_t i = 0; i < after.state.displacement.size(); ++i)
    change = std::max(change, std::abs(after.state.displacement[i] - before.state.displacement[i]));
  const double motion = largest(after.state.displacement);
  report.correction = motion > 0 ? change / motion : 0;
  for (std::size_t k = 0; k < after.at.status.size(); ++k)
  {
    report.n_status_changes += after.at.status[k] != before.at.status[k];
    report.n_stick += after.at.status[k] == ContactStatus::stick;
    report.n_slip += after.at.status[k] == ContactStatus::slip;
  }
  report.n_active = report.n_stick + report.n_slip;
  report.remark = remark(after.at, before.at.status);
  return report;
}

void Newton::set_trial(const State &trial, const State &start)
{
  for (ContactInterface &contact : model_.contacts())
    contact.set_trial(trial.displacement, start.displacement);
}

void Newton::iterate(Iterate &now, const State &start, double time, NewtonOutcome &outcome)
{
  const SolverOptions &options = model_.options().solver;
  std::map<std::uint64_t, int> seen;
  int n_cycles = 0;
  int n_damped = 0;
  double last_norm = now.at.norm;
  const auto contacts = std::span(std::as_const(model_).contacts());
  bool settled = std::all_of(contacts.begin(), contacts.end(), [](const auto &c) { return c.options().tied; });
  for (int iteration = 1; now.at.norm > options.tolerance * now.at.scale || now.at.pending_motion > 0; ++iteration)
  {
    if (iteration > options.max_iterations)
      throw NumericalFailure("no convergence in " + std::to_string(options.max_iterations) + " iterations");
    contacts_.remember_slip();
    restrain(now.at, now.state, start, time, iteration == 1 && !now.has_trial);
    const auto n_before = form_->counters().n_iterations;
    const std::vector<double> increment =
        solve_linear(now.at, linear_tolerance(now.at, last_norm, settled, !now.has_trial && has_friction(model_)));
    outcome.n_iterations = iteration;
    outcome.n_linear_iterations += static_cast<int>(form_->counters().n_iterations - n_before);
    ++counters_.n_newton_iterations;

    double share = 1;
    Iterate next = step_from(now, start, time, increment, n_damped > 0, share);
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
    settled = model_.small_strain() && report.n_status_changes <= few_changes * report.n_active;
    now = std::move(next);
    if (n_cycles > max_cycles)
      throw NumericalFailure("statuses or faces turn in a circle" +
                             (report.remark.empty() ? "" : ": " + report.remark));
  }
}

bool Newton::nothing_closed() const
{
  for (const ContactInterface &contact : std::as_const(model_).contacts())
    for (Index i = 0; i < contact.n_nodes(); ++i)
      if (contact.committed_status(i) != ContactStatus::open)
        return false;
  return true;
}

Newton::Iterate Newton::begin(const State &start, double time, const State *guess)
{
  form_->set_held_modes({});
  contacts_.forget_slip();
  Iterate out;
  out.state = guess ? *guess : start;
  detect(out.state);
  Closed touching;
  // FreeMotions chooses by itself what closes first where forces move bodies.
  if (!guess && !free_motions_.any() && (!has_friction(model_) || nothing_closed()))
  {
    const State approach = predictor_.approach(start, time);
    touching = predictor_.touching(start, approach);
    out.has_trial = !touching.empty();
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

NewtonOutcome Newton::solve(State &state, double from, double to)
{
  NewtonOutcome outcome;
  const State start = state;
  std::optional<State> guess = predictor_.guess(start, from, to);
  while (true)
    try
    {
      attempt(state, start, to, guess ? &*guess : nullptr, outcome);
      predictor_.remember(start, from, to);
      break;
    }
    catch (const NumericalFailure &failure)
    {
      outcome.cause = failure.what();
      if (!guess)
        break;
      // A guess may lead astray where nodes change faces: the increment is tried without.
      guess.reset();
      begin_increment(start, reach_);
    }
  return outcome;
}
} // namespace amontons
