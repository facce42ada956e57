#pragma once
#include "amontons/base/ids.h"

#include <vector>

namespace amontons
{
/// Representative of the set an element is in; ways are shortened as they are gone (Tarjan 1975).
/// @param parent of each element, itself where it represents its set
inline Index find_root(std::vector<Index> &parent, Index element)
{
  while (parent[element] != element)
    element = parent[element] = parent[parent[element]];
  return element;
}
} // namespace amontons
