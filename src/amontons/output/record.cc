#include "amontons/output/record.h"

#include "amontons/output/version.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace amontons
{
using Json = nlohmann::ordered_json;

namespace
{
std::span<const double> vector(const std::array<double, 3> &components, int dim)
{
  return {components.data(), static_cast<std::size_t>(dim)};
}

Json contact_entry(const ContactResult &contact)
{
  return {{"name", contact.name},
          {"n_impactor_nodes", contact.n_nodes},
          {"n_active", contact.n_active},
          {"n_stick", contact.n_stick},
          {"n_slip", contact.n_slip},
          {"normal_force", vector(contact.normal_force, contact.dim)},
          {"tangential_force", vector(contact.tangential_force, contact.dim)},
          {"max_pressure", contact.max_pressure},
          {"min_gap", contact.min_gap}, // infinity is written null
          {"contact_area", contact.contact_area}};
}

Json increment_entry(const IncrementReport &report, const SolutionState &state)
{
  Json entry = {{"increment", state.increment},
                {"time", report.time},
                {"time_step", report.time_step},
                {"newton_iterations", report.newton_iterations},
                {"linear_iterations", report.linear_iterations},
                {"cutbacks", report.cutbacks},
                {"contacts", Json::array()},
                {"reactions", Json::array()}};
  for (const ContactResult &contact : state.contacts)
    entry["contacts"].push_back(contact_entry(contact));
  for (const Reaction &reaction : state.reactions)
    entry["reactions"].push_back({{"region", reaction.region}, {"force", vector(reaction.force, state.mesh->dim)}});
  return entry;
}

constexpr std::array phases{"mesh",         "setup",        "detection", "bulk_assembly", "contact_assembly",
                            "linear_setup", "linear_solve", "output"};

rusage usage_so_far()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

/// Largest resident memory of this process so far, 10^6 bytes.
double peak_rss_mb()
{
  return static_cast<double>(usage_so_far().ru_maxrss) * 1024 * 1e-6;
}

/// Processor time of this process so far, s.
double cpu_s()
{
  const auto seconds = [](const timeval &time)
  { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
  const rusage usage = usage_so_far();
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Numbers of one process, each with its place as a JSON pointer (RFC 6901).
using Numbers = std::vector<std::pair<std::string, double>>;

Numbers numbers_of_process(const SolutionState &state, const Timers &timers)
{
  double n_contact_nodes = 0;
  for (const ContactResult &contact : state.contacts)
    n_contact_nodes += contact.n_own;
  Numbers out{{"/n_cells", state.mesh->cells.size()},
              {"/n_nodes", state.mesh->n_nodes()},
              {"/n_contact_nodes", n_contact_nodes},
              {"/peak_rss_mb", peak_rss_mb()},
              {"/cpu_s", cpu_s()}};
  for (const char *phase : phases)
  {
    const auto found = timers.seconds().find(phase);
    out.emplace_back(std::string("/timings/") + phase, found == timers.seconds().end() ? 0.0 : found->second);
  }
  for (const auto &[phase, traffic] : state.nodes->messages()->traffic())
    for (const auto &[name, number] :
         {std::pair("messages", traffic.messages), std::pair("bytes", traffic.bytes),
          std::pair("reductions", traffic.reductions), std::pair("reduced_bytes", traffic.reduced_bytes)})
      out.emplace_back("/traffic/" + phase + '/' + name, static_cast<double>(number));
  return out;
}

/// Each number's least and greatest over the processes, and its sum. Collective.
Json compared(const Numbers &numbers, const Sharing &nodes)
{
  std::vector<double> least, greatest, sum;
  for (const auto &[place, number] : numbers)
  {
    least.push_back(-number);
    greatest.push_back(number);
    sum.push_back(number);
  }
  nodes.maximum_over_processes(least);
  nodes.maximum_over_processes(greatest);
  nodes.sum_over_processes(sum);
  Json out;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out[Json::json_pointer(numbers[i].first)] = {{"min", -least[i]}, {"max", greatest[i]}, {"sum", sum[i]}};
  return out;
}
} // namespace

RunRecord::RunRecord(const ResultFolder &folder, const std::string &title, const std::string &deck)
  : folder_(folder)
  , record_(std::make_unique<Json>(Json{{"version", version()},
                                        {"title", title},
                                        {"deck", deck},
                                        {"status", "running"},
                                        {"processes", folder.communicator().size()},
                                        {"n_dofs", nullptr},
                                        {"increments", Json::array()},
                                        {"rejected", Json::array()},
                                        {"warnings", Json::array()},
                                        {"totals", Json::object()}}))
{
}

RunRecord::~RunRecord() = default;

void RunRecord::resume(Json earlier, int increment)
{
  for (const char *list : {"increments", "rejected", "warnings", "restarts"})
    if (earlier.contains(list))
      (*record_)[list] = std::move(earlier[list]);
  (*record_)["restarts"].push_back({{"after_increment", increment}});
  waits_to_go_on_ = true;
}

void RunRecord::start(const SolutionState & /*initial*/, std::int64_t n_dofs)
{
  waits_to_go_on_ = false;
  (*record_)["n_dofs"] = n_dofs;
  write();
}

void RunRecord::accepted(const IncrementReport &report, const SolutionState &state)
{
  (*record_)["increments"].push_back(increment_entry(report, state));
  write();
}

void RunRecord::rejected(const IncrementReport &report, const std::string &cause)
{
  (*record_)["rejected"].push_back({{"time", report.time},
                                    {"time_step", report.time_step},
                                    {"newton_iterations", report.newton_iterations},
                                    {"cause", cause}});
}

void RunRecord::warning(const std::string &message)
{
  (*record_)["warnings"].push_back(message);
}

void RunRecord::finish(const SolutionState &last, const Counters &counters, const Timers &timers,
                       const std::string &failure)
{
  add_totals(counters, timers);
  if (last.nodes->is_distributed())
    compare_processes(last, timers);
  if (!failure.empty())
    return fail(failure);
  (*record_)["status"] = "converged";
  write();
}

void RunRecord::add_totals(const Counters &counters, const Timers &timers)
{
  Json &totals = (*record_)["totals"];
  for (const char *phase : phases) // a phase that was never entered took no time
    totals["timings"][phase] = 0.0;
  totals["timings"].update(timers.seconds());
  totals["n_bulk_assemblies"] = counters.n_bulk_assemblies;
  totals["n_pattern_builds"] = counters.n_pattern_builds;
  totals["n_contact_updates"] = counters.n_contact_updates;
  totals["n_factorizations"] = counters.n_factorizations;
  totals["n_preconditioner_setups"] = counters.n_preconditioner_setups;
  totals["n_detections"] = counters.n_detections;
  totals["n_newton_iterations"] = counters.n_newton_iterations;
  totals["n_linear_iterations"] = counters.n_linear_iterations;
}

void RunRecord::compare_processes(const SolutionState &last, const Timers &timers)
{
  Json &processes = (*record_)["totals"]["processes"] = compared(numbers_of_process(last, timers), *last.nodes);
  peak_rss_mb_ = processes["peak_rss_mb"]["max"];
}

void RunRecord::fail(const std::string &cause)
{
  if (waits_to_go_on_)
    return;
  (*record_)["status"] = "failed";
  (*record_)["failure"] = cause;
  write();
}

void RunRecord::write()
{
  if (!folder_.communicator().is_root())
    return;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
  (*record_)["totals"]["wall_s"] = wall.count();
  (*record_)["totals"]["peak_rss_mb"] = std::max(peak_rss_mb_, peak_rss_mb());
  folder_.write("record.json", record_->dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}
} // namespace amontons
