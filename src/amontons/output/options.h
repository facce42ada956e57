#pragma once
#include <string>
#include <vector>

namespace amontons
{
enum class OutputField
{
  displacement,
  stress
};

struct OutputOptions
{
  std::vector<OutputField> fields{OutputField::displacement, OutputField::stress};
  int every = 1; ///< write pictures every n increments, and the last; 0: never
};
} // namespace amontons
