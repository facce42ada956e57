#pragma once
#include "amontons/output/folder.h"
#include "amontons/output/options.h"
#include "amontons/output/vtu.h"
#include "amontons/solution/observer.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace amontons
{
/// The bodies of a state as a grid in reference coordinates: the fields asked for, body of each cell.
/// Facets of a rigid body meshed by its surface alone are cells too. Over several processes a process's cells with the
/// nodes that are theirs or its own.
VtuGrid body_grid(const SolutionState &state, const std::vector<BodyOptions> &bodies,
                  const std::vector<OutputField> &fields);

/// A contact's impactor surface as a grid in reference coordinates, with everything of `contact` on its nodes.
VtuGrid contact_grid(const ContactResult &contact, const SolutionState &state);

/// Writes solution.pvd, contact_<name>.pvd and their .vtu files: the initial state, every n-th increment, the last.
/// Over several processes each writes the .vtu of its own cells and faces, process 0 the .pvtu that holds them
/// together.
class Pictures : public Observer
{
public:
  /// `folder` must outlive it.
  Pictures(const ResultFolder &folder, OutputOptions options, std::vector<BodyOptions> bodies);

  /// By stem: time and file.
  using Series = std::map<std::string, std::vector<std::pair<double, std::string>>>;
  /// Goes on with the series of an earlier run, as far as its files are in the folder. For process 0.
  void resume(Series earlier);
  /// As process 0 has it; empty elsewhere.
  [[nodiscard]] const Series &series() const { return series_; }

  void start(const SolutionState &initial, std::int64_t n_dofs) override;
  void accepted(const IncrementReport &report, const SolutionState &state) override;
  void finish(const SolutionState &last, const Counters &counters, const Timers &timers,
              const std::string &failure) override;

private:
  void write(const SolutionState &state);
  /// One file, or over several processes a piece of each and what holds them together. @return the name of the file
  std::string write_grid(const std::string &name, const VtuGrid &grid) const;
  void add(const std::string &stem, const SolutionState &state, const std::string &file);

  const ResultFolder &folder_;
  OutputOptions options_;
  std::vector<BodyOptions> bodies_;
  int last_written_ = -1; ///< increment
  Series series_;
};
} // namespace amontons
