#include "amontons/exchange/measures.h"

#include "amontons/detection/search_distance.h"

#include <cmath>

namespace amontons
{
namespace
{
Box box_of_all(std::span<const double> x, int dim, Index n_nodes)
{
  Box box;
  double sum = 0;
  for (Index node = 0; node < n_nodes; ++node)
  {
    const Place place = place_of(x, dim, node);
    box.include(place);
    sum += place[0] + place[1] + place[2];
  }
  if (!std::isfinite(sum))
    throw NumericalFailure("contact detection: the nodes' positions are not finite");
  return box;
}

SearchDistance distance_for(const ContactShare &share, const SharePositions &positions, const DetectionOptions &options)
{
  Target target(target_of(share));
  target.move_to(target_positions(share, positions));
  return search_distance(target, options, positions.reach);
}

DetectionOptions without_distance(DetectionOptions options)
{
  options.distance.reset();
  return options;
}
} // namespace

bool is_to_be_checked(const DetectionOptions &options)
{
  return options.distance && options.method == DetectionMethod::nearest_node;
}

Measures measure(const ContactShare &share, const SharePositions &positions)
{
  const int dim = share.impactor->dim;
  const Surface &target = target_of(share);
  const std::span<const double> target_x = target_positions(share, positions);
  AMONTONS_ASSERT(target.dim == dim);
  AMONTONS_ASSERT(share.n_own >= 0 && share.n_own <= share.impactor->n_nodes());
  AMONTONS_ASSERT(positions.impactor.size() == share.impactor->node_ids.size() * dim);
  AMONTONS_ASSERT(target_x.size() == target.node_ids.size() * dim);
  if (!share.target && share.impactor->reference.size() != share.impactor->node_ids.size() * dim)
    throw UserError("contact detection: self-contact needs the reference coordinates of the surface's nodes, " +
                    std::to_string(dim) + " to each");
  Measures result;
  result.impactor = box_of_all(positions.impactor, dim, share.n_own);
  result.target = box_of_all(target_x, dim, target.n_nodes());
  result.distance =
      is_to_be_checked(share.detection) ? *share.detection.distance : distance_for(share, positions, share.detection).w;
  return result;
}

double least_distance(const ContactShare &share, const SharePositions &positions)
{
  if (!is_to_be_checked(share.detection))
    return 0;
  SharePositions at_rest = positions;
  at_rest.reach = 0;
  return distance_for(share, at_rest, without_distance(share.detection)).w;
}

void check_distance(const ContactShare &share, const SharePositions &positions, double least)
{
  if (is_to_be_checked(share.detection) && least_distance(share, positions) == least)
    distance_for(share, positions, share.detection);
}

double motion(int dim, std::span<const double> before, std::span<const double> now)
{
  double largest = 0;
  for (std::size_t i = 0; i < now.size(); i += dim)
  {
    double squared = 0;
    for (int c = 0; c < dim; ++c)
      squared += (now[i + c] - before[i + c]) * (now[i + c] - before[i + c]);
    largest = std::max(largest, squared);
  }
  return std::sqrt(largest);
}
} // namespace amontons
