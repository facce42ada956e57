#pragma once
#include "amontons/output/folder.h"
#include "amontons/solution/observer.h"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <memory>
#include <string>

namespace amontons
{
/// Keeps record.json (docs/outputs.md) up to date: at the start, after every increment, at the end. Every process has
/// one, process 0 writes.
class RunRecord : public Observer
{
public:
  /// `folder` must outlive it.
  RunRecord(const ResultFolder &folder, const std::string &title, const std::string &deck);
  ~RunRecord() override;

  /// Goes on with the record of an earlier run, as written() gave it.
  /// @param increment after which this run goes on
  void resume(nlohmann::ordered_json earlier, int increment);
  [[nodiscard]] const nlohmann::ordered_json &written() const { return *record_; }

  void start(const SolutionState &initial, std::int64_t n_dofs) override;
  void accepted(const IncrementReport &report, const SolutionState &state) override;
  void rejected(const IncrementReport &report, const std::string &cause) override;
  void warning(const std::string &message) override;
  void finish(const SolutionState &last, const Counters &counters, const Timers &timers,
              const std::string &failure) override;

  /// For a run that an exception ended: status "failed", with its cause. A record that was to go on and did not yet
  /// stays as it is. Local.
  void fail(const std::string &cause);

private:
  void add_totals(const Counters &counters, const Timers &timers);
  /// What the processes differ in. Collective.
  void compare_processes(const SolutionState &last, const Timers &timers);
  void write();

  const ResultFolder &folder_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::unique_ptr<nlohmann::ordered_json> record_;
  double peak_rss_mb_ = 0; ///< greatest of all processes, once known
  bool waits_to_go_on_ = false;
};
} // namespace amontons
