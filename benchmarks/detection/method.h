#pragma once
#include "detection/scene.h"

#include <ctime>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace amontons::benchmark
{
/// What a detection took, in seconds of processor time.
struct Phases
{
  double setup = 0; ///< topology, once and for all: what does not hang on where the nodes are
  double build = 0, query = 0;
  std::map<std::string, double> steps; ///< where the method tells its own
};

/// Processor time of this process, in seconds: nothing else runs in it.
inline double processor_time()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// One way to find the closest face of every impactor node; lives for one series of detections.
class Method
{
public:
  virtual ~Method() = default;

  /// Finds, for each impactor node, the closest target face within the scene's distance. The first call starts from
  /// nothing, those that follow may use what they keep.
  virtual Phases detect(const Positions &positions) = 0;

  /// Distances to the target that were found, infinite where nothing was.
  [[nodiscard]] virtual std::vector<double> distances() const = 0;

  /// Whether what it keeps between detections serves it, so that it is to be seen over several motions.
  [[nodiscard]] virtual bool keeps_pairs() const { return false; }

  /// Memory that it holds apart from the heap.
  [[nodiscard]] virtual std::size_t bytes_apart() const { return 0; }
};

/// "exact" or "nearest-node". @param bare every node takes its closest point, past the target's ends and through thin
/// bodies too, as the libraries do: for comparing distances
std::unique_ptr<Method> make_own_method(const Scene &scene, const std::string &name, bool bare);
std::unique_ptr<Method> make_nanoflann_method(const Scene &scene);
std::unique_ptr<Method> make_cgal_method(const Scene &scene);
std::unique_ptr<Method> make_embree_method(const Scene &scene);
} // namespace amontons::benchmark
