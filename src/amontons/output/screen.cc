#include "amontons/output/screen.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>
#include <span>

namespace amontons
{
namespace
{
constexpr int bar_width = 40;
/// Phases below this part of the run are not worth a mention.
constexpr double least_share = 0.01;

std::string text_of(const std::array<double, 3> &vector, int dim)
{
  return fmt::format("({:.6g})", fmt::join(std::span(vector).first(static_cast<std::size_t>(dim)), ", "));
}

std::string plural(std::int64_t n, const char *word)
{
  return fmt::format("{} {}{}", n, word, n == 1 ? "" : "s");
}

std::string contact_line(const ContactResult &contact)
{
  std::string text = fmt::format("  {}: {} of {} nodes closed, {} stick, {} slip", contact.name, contact.n_active,
                                 contact.n_nodes, contact.n_stick, contact.n_slip);
  if (contact.n_active > 0)
    text += fmt::format("; normal force {}, tangential {}, greatest pressure {:.6g}, area {:.6g}",
                        text_of(contact.normal_force, contact.dim), text_of(contact.tangential_force, contact.dim),
                        contact.max_pressure, contact.contact_area);
  return text;
}

/// "linear_solve 61 %, bulk_assembly 12 %", the longest first.
std::string shares(const Timers &timers, double wall)
{
  std::vector<std::pair<double, std::string>> phases;
  for (const auto &[phase, seconds] : timers.seconds())
    if (seconds > least_share * wall)
      phases.emplace_back(seconds, phase);
  std::sort(phases.rbegin(), phases.rend());
  std::string text;
  for (const auto &[seconds, phase] : phases)
    text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", phase, 100 * seconds / wall);
  return text;
}
} // namespace

void Screen::start(const SolutionState &initial, std::int64_t n_dofs)
{
  n_dim_ = initial.mesh->dim;
  line(fmt::format("{}, {}, {}", plural(initial.mesh->n_global_nodes, "node"),
                   plural(initial.mesh->n_global_cells, "cell"), plural(n_dofs, "unknown")));
  if (initial.increment > 0)
    line(fmt::format("goes on from increment {}, t = {:.6g}", initial.increment, initial.time));
}

void Screen::begin_increment(int increment, double time, double time_step)
{
  line(fmt::format("\nincrement {}, t = {:.6g} (step {:.4g})", increment, time, time_step));
  line("   it   residual  correction  changes   active    stick     slip  step  remark");
}

void Screen::iteration(const IterationReport &report)
{
  line(fmt::format("  {:3}  {:9.2e}   {:9.2e}  {:7}  {:7}  {:7}  {:7}  {:4.2g}  {}", report.iteration, report.residual,
                   report.correction, report.n_status_changes, report.n_active, report.n_stick, report.n_slip,
                   report.step_length, report.remark));
}

void Screen::accepted(const IncrementReport &report, const SolutionState &state)
{
  time_ = report.time;
  line(fmt::format("  converged in {}", plural(report.newton_iterations, "iteration")));
  for (const ContactResult &contact : state.contacts)
    line(contact_line(contact));
}

void Screen::rejected(const IncrementReport & /*report*/, const std::string &cause)
{
  line("  not converged: " + cause);
}

void Screen::warning(const std::string &message)
{
  line("warning: " + message);
}

void Screen::finish(const SolutionState &last, const Counters &counters, const Timers &timers,
                    const std::string &failure)
{
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  erase_bar();
  terminal_ = false; // the bar has had its day
  if (failure.empty())
    line(fmt::format("\nsolved to t = {:.6g}", last.time));
  else
    line(fmt::format("\nstopped at t = {:.6g} of {:.6g}: {}", last.time, end_time_, failure));
  line(fmt::format("  {}, {}, {}, {}, {}", plural(last.increment, "increment"),
                   plural(counters.n_newton_iterations, "Newton iteration"),
                   plural(counters.n_factorizations, "factorization"), plural(counters.n_detections, "detection"),
                   fmt::format("{:.1f} s", wall)));
  if (const std::string text = shares(timers, wall); !text.empty())
    line("  time: " + text);
  for (const Reaction &reaction : last.reactions)
    line(fmt::format("  reaction of {}: {}", reaction.region, text_of(reaction.force, n_dim_)));
}

void Screen::line(const std::string &text)
{
  erase_bar();
  out_ << text << '\n';
  draw_bar();
  out_.flush();
}

void Screen::draw_bar()
{
  if (!terminal_)
    return;
  const double part = end_time_ > 0 ? std::clamp(time_ / end_time_, 0.0, 1.0) : 0.0;
  const int filled = static_cast<int>(part * bar_width);
  out_ << fmt::format("[{:=<{}}{:{}}] {:3.0f} %", "", filled, "", bar_width - filled, 100 * part);
  bar_is_drawn_ = true;
}

void Screen::erase_bar()
{
  if (bar_is_drawn_)
    out_ << "\r\033[K";
  bar_is_drawn_ = false;
}
} // namespace amontons
