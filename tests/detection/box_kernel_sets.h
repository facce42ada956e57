#pragma once
#include "amontons/detection/box_kernels.h"
#include "amontons/surface/instruction_set.h"

#include <vector>

namespace amontons::test
{
/// The kernels of every instruction set that this processor has.
template<int dim>
std::vector<BoxKernels<dim>> kernels_of_this_processor()
{
  std::vector<InstructionSet> sets{InstructionSet::baseline};
  if (instruction_set() != InstructionSet::baseline)
    sets.push_back(InstructionSet::avx2);
  if (instruction_set() == InstructionSet::avx512)
    sets.push_back(InstructionSet::avx512);
  std::vector<BoxKernels<dim>> result;
  for (const InstructionSet set : sets)
    if constexpr (dim == 2)
      result.push_back(set == InstructionSet::baseline ? baseline::box_kernels_2()
                       : set == InstructionSet::avx2   ? avx2::box_kernels_2()
                                                       : avx512::box_kernels_2());
    else
      result.push_back(set == InstructionSet::baseline ? baseline::box_kernels_3()
                       : set == InstructionSet::avx2   ? avx2::box_kernels_3()
                                                       : avx512::box_kernels_3());
  return result;
}
} // namespace amontons::test
