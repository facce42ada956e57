#pragma once
#include "amontons/exchange/parallel_detector.h"

namespace amontons
{
/// The five steps of Yastrebov, Cailletaud, Feyel 2011 (THEORY.md section 5): all send their surfaces to process 0; it
/// fixes w, bounds and cells, cuts the grid into parts of equal volume and hands them out with one further layer of
/// cells; each process detects in its part and returns what it found; process 0 hands that on to the nodes' owners.
std::unique_ptr<ParallelDetector> make_gathered_detector(const Communicator &communicator,
                                                         std::vector<ContactShare> shares);
} // namespace amontons
