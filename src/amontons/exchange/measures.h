#pragma once
#include "amontons/exchange/box.h"
#include "amontons/exchange/parallel_detector.h"

#include <span>
#include <vector>

namespace amontons
{
/// What of a contact is the least or the greatest over all processes.
struct Measures
{
  Box impactor, target;
  double distance = 0; ///< w
  /// The farthest that a node of either side is from where it was when routes were made.
  double impactor_motion = 0, target_motion = 0;

  /// How far the sides may have come nearer to each other since.
  [[nodiscard]] double approach() const { return impactor_motion + target_motion; }
};

/// Of a share: w is the user's, or what the share's own faces ask for.
/// @throws UserError for a distance that no detection takes; NumericalFailure if a position is not finite
Measures measure(const ContactShare &share, const SharePositions &positions);

/// Nearest-node detection needs a w that covers the faces: a user's is held against it.
bool is_to_be_checked(const DetectionOptions &options);
/// @return the least w that this share's faces ask for; 0 where nothing is to be checked
double least_distance(const ContactShare &share, const SharePositions &positions);
/// @param least of all shares: only who holds the face that asks for it speaks
/// @throws UserError where the user's w is less
void check_distance(const ContactShare &share, const SharePositions &positions, double least);

/// The largest distance between a node's places.
double motion(int dim, std::span<const double> before, std::span<const double> now);

/// The target of a share, and where it is: in self-contact the impactor's faces.
inline const Surface &target_of(const ContactShare &share)
{
  return share.target ? *share.target : *share.impactor;
}
inline std::span<const double> target_positions(const ContactShare &share, const SharePositions &positions)
{
  return share.target ? positions.target : positions.impactor;
}
} // namespace amontons
