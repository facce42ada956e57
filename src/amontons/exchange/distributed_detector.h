#pragma once
#include "amontons/exchange/parallel_detector.h"

namespace amontons
{
/// No process sees more than its part: bounds and w by reduction; space cut into parts of as many nodes and faces
/// (SpaceCut), one a process; surfaces straight to the parts that need them, pairs straight to the nodes' owners.
/// Self-contact is cut in the reference, each contact by itself; all others together as they are now.
/// @param skin ExchangeOptions::skin
std::unique_ptr<ParallelDetector> make_distributed_detector(const Communicator &communicator, double skin,
                                                            std::vector<ContactShare> shares);
} // namespace amontons
