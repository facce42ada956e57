#pragma once
#include <string>
#include <vector>

namespace amontons
{
enum class OutputField
{
  displacement,
  stress,
  plastic_strain
};

struct OutputOptions
{
  std::vector<OutputField> fields{OutputField::displacement, OutputField::stress, OutputField::plastic_strain};
  int every = 1;      ///< write pictures every n increments, and the last; 0: never
  int checkpoint = 0; ///< write a checkpoint every n increments, and at the last; 0: never
};
} // namespace amontons
