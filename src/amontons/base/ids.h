#pragma once
#include <cstdint>

namespace amontons
{
/// Position in an array of this process.
using Index = int;
/// Identifier that means the same on every process.
using GlobalIndex = std::int64_t;
/// Position of a process in its communicator.
using Rank = int;
} // namespace amontons
