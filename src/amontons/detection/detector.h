#pragma once
#include "amontons/detection/options.h"
#include "amontons/detection/report.h"
#include "amontons/surface/pairing.h"
#include "amontons/surface/surface.h"

#include <memory>
#include <span>

namespace amontons
{
/// Finds the target face of each impactor node. One detector per contact: it keeps its buffers and the last pairing.
class Detector
{
public:
  virtual ~Detector() = default;

  /// @param impactor_x, target_x current coordinates, [n_nodes * dim]
  /// @param reach largest gap at which a node must still be met (twice the largest relative motion expected); enters
  /// the
  ///        automatic w; 0 gives the least w that covers the target
  /// @throws UserError if the user's w is below what covers the target's faces, naming the face and the least w.
  virtual const Pairing &detect(std::span<const double> impactor_x, std::span<const double> target_x, double reach) = 0;

  /// Of the last detect().
  [[nodiscard]] virtual DetectionReport report() const = 0;
};

/// The surfaces must outlive the detector; their adjacency must be built.
std::unique_ptr<Detector> make_detector(const DetectionOptions &options, const Surface &impactor,
                                        const Surface &target);
} // namespace amontons
