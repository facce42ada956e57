#pragma once
#include "amontons/detection/options.h"
#include "amontons/detection/report.h"
#include "amontons/surface/pairing.h"
#include "amontons/surface/surface.h"

#include <memory>
#include <optional>
#include <span>

namespace amontons
{
/// Finds the target face of each impactor node. One detector per contact: it keeps its buffers and the last pairing.
///
/// **What is found.** `exact` and `brute`: the closest point of the target within w, on any mesh; equal distances go to
/// the smaller face id. `nearest_node`: the closest point on the faces attached to the nearest target node within w,
/// which on graded or stretched meshes need not be the closest of all. The face that gives n, xi and gap at edges and
/// vertices is chosen by the table in closest_feature.h.
///
/// **Ends.** A node past the end of an open target is paired with the last face, extended, as long as it is no farther
/// past it than `extension`; by default 0.1 of that face's extent in that direction. An extension of 0 keeps the target
/// from extending; round-off (1e-9 of the face) is not past the end.
///
/// **Sides.** A node outside the target's body takes its closest point, whatever lies behind it: on a thin body never
/// the far side. A node seen from inside is paired as deep as w. If it has crossed more than half of a thin body, the
/// closest point is the far side's, to be told by the impactor: where its own normal there (the mean of its current
/// faces) and the face's make an angle of less than 60 degrees, the node did not come through that face. It takes the
/// closest of those points within w that are seen from inside and do not face its way; without one it is `behind`.
///
/// **Other points.** Where the closest point does not do (past the end, behind), the next local minimum of the distance
/// that does is taken: past one terrace's end lies the next terrace.
///
/// **Self-contact** (make_self_detector). A node does not see the faces that Exclusions names. Of the rest it takes the
/// closest point that is a local minimum of the distance from the whole surface: the rim of what is hidden is none.
/// Then Roles decides which nodes keep their face as impactors.
class Detector
{
public:
  virtual ~Detector() = default;

  /// @param impactor_x, target_x current coordinates, [n_nodes * dim]
  /// Local to the process.
  /// @param reach largest gap at which a node must still be met (twice the largest relative motion expected); enters
  ///        the automatic w; 0 gives the least w that covers the target
  /// @throws UserError if the user's w is not positive, or with `nearest_node` below what covers the target's faces,
  ///         naming the face and the least w; NumericalFailure if a position is not finite
  virtual const Pairing &detect(std::span<const double> impactor_x, std::span<const double> target_x, double reach) = 0;

  /// The same with w given by one who knows it of a larger target, of which this one is a part; the options' own is not
  /// asked for, nor held against the faces.
  virtual const Pairing &detect_within(std::span<const double> impactor_x, std::span<const double> target_x,
                                       double w) = 0;

  /// Of the last detect().
  [[nodiscard]] virtual DetectionReport report() const = 0;
};

/// The surfaces must outlive the detector; their adjacency must be built.
std::unique_ptr<Detector> make_detector(const DetectionOptions &options, const Surface &impactor,
                                        const Surface &target);

/// One surface as impactor and target; detect() takes the same coordinates for both.
/// @param self_distance along the surface, in the reference, within which a node sees no face; absent: twice the
///        longest edge of the node's faces
/// @throws UserError if it is negative or not finite
std::unique_ptr<Detector> make_self_detector(const DetectionOptions &options, const Surface &surface,
                                             std::optional<double> self_distance = {});

/// Self-contact before Roles: the face that each node sees, whichever side it is of.
std::unique_ptr<Detector> make_sight_detector(const DetectionOptions &options, const Surface &surface,
                                              std::optional<double> self_distance = {});
} // namespace amontons
