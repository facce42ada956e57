#pragma once

namespace amontons
{
/// The instruction sets that kernels are compiled for, and the best of them that this processor has.
enum class InstructionSet
{
  baseline, ///< any x86-64, or another processor
  avx2,
  avx512
};
InstructionSet instruction_set();

/// The kernel for this processor, of one compiled for each instruction set.
template<typename Kernel>
Kernel kernel_for_processor(Kernel baseline, [[maybe_unused]] Kernel avx2, [[maybe_unused]] Kernel avx512)
{
  switch (instruction_set())
  {
  case InstructionSet::avx512:
    return avx512;
  case InstructionSet::avx2:
    return avx2;
  case InstructionSet::baseline:
    break;
  }
  return baseline;
}
} // namespace amontons
