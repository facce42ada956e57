#pragma once
#include "amontons/solution/observer.h"

#include <chrono>
#include <iosfwd>
#include <string>

namespace amontons
{
/// Shows a run as text: a table of increments and iterations with remarks, a closing summary, and on a terminal a
/// progress bar below them.
class Screen : public Observer
{
public:
  /// `out` must outlive it. @param end_time of the run. @param terminal draw the progress bar
  Screen(std::ostream &out, double end_time, bool terminal)
    : out_(out)
    , end_time_(end_time)
    , terminal_(terminal)
  {
  }

  void start(const SolutionState &initial, std::int64_t n_dofs) override;
  void begin_increment(int increment, double time, double time_step) override;
  void iteration(const IterationReport &report) override;
  void accepted(const IncrementReport &report, const SolutionState &state) override;
  void rejected(const IncrementReport &report, const std::string &cause) override;
  void warning(const std::string &message) override;
  void finish(const SolutionState &last, const Counters &counters, const Timers &timers,
              const std::string &failure) override;

private:
  /// Prints a line above the progress bar.
  void line(const std::string &text);
  void draw_bar();
  void erase_bar();

  std::ostream &out_;
  double end_time_;
  bool terminal_;
  bool bar_is_drawn_ = false;
  double time_ = 0; ///< reached so far
  int n_dim_ = 2;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
} // namespace amontons
