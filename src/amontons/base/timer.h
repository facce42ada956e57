#pragma once
#include <chrono>
#include <map>
#include <string>

namespace amontons
{
/// Wall-clock seconds by named phase, summed over all visits.
class Timers
{
public:
  /// Adds the time of its own life to a phase.
  class Scope
  {
  public:
    Scope(Timers &timers, std::string phase)
      : timers_(timers)
      , phase_(std::move(phase))
      , start_(Clock::now())
    {
    }
    Scope(const Scope &) = delete;
    Scope &operator=(const Scope &) = delete;
    ~Scope() { timers_.seconds_[phase_] += std::chrono::duration<double>(Clock::now() - start_).count(); }

  private:
    Timers &timers_;
    std::string phase_;
    std::chrono::steady_clock::time_point start_;
  };

  [[nodiscard]] Scope measure(const std::string &phase) { return {*this, phase}; }
  [[nodiscard]] const std::map<std::string, double> &seconds() const { return seconds_; }

private:
  using Clock = std::chrono::steady_clock;
  std::map<std::string, double> seconds_;
};
} // namespace amontons
