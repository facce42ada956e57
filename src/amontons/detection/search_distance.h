#pragma once
#include "amontons/detection/options.h"
#include "amontons/detection/target.h"

namespace amontons
{
/// The least radius at which balls about the face's nodes cover the face: half the length of a segment, the
/// circumradius of an acute triangle; of a quadrilateral the better of its two triangulations, and what it bulges from
/// them added, or the farthest corner of a quarter from its node, if that is less.
double covering_radius(const FaceCoordinates &face);

/// The detection distance w and the face that sets it.
struct SearchDistance
{
  double w = 0;
  Index face = -1; ///< -1 where the user gave w
};

/// Automatic: sqrt(covering radius^2 + reach^2) and 1 % on top (THEORY.md section 4), the radius that of the face that
/// needs most.
/// @throws UserError if the user's w is not positive, or if the nearest-node method is to work with less than the
///         covering radius; it names the face and the least admissible w.
SearchDistance search_distance(const Target &target, const DetectionOptions &options, double reach);
} // namespace amontons
