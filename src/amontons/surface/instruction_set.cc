#include "amontons/surface/instruction_set.h"

namespace amontons
{
namespace
{
InstructionSet detect()
{
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return InstructionSet::avx512;
  if (__builtin_cpu_supports("avx2"))
    return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}
} // namespace

InstructionSet instruction_set()
{
  static const InstructionSet set = detect();
  return set;
}
} // namespace amontons
