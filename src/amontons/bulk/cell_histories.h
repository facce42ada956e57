#pragma once
#include "amontons/base/ids.h"

#include <cstddef>
#include <vector>

namespace amontons
{
/// What the points of plastic cells remember, cell by cell, whatever subdomains they lie in.
struct CellHistories
{
  std::vector<Index> cells;        ///< of the mesh
  std::vector<std::size_t> offset; ///< of each cell in values, and the end
  std::vector<double> values;      ///< of each point seven: the plastic strain, column by column, the equivalent one
};
} // namespace amontons
