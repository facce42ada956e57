#include "amontons/detection/box_kernels.h"

#include "amontons/surface/instruction_set.h"

namespace amontons
{
template<>
const BoxKernels<2> &box_kernels<2>()
{
  static const BoxKernels<2> kernels =
      kernel_for_processor(baseline::box_kernels_2, avx2::box_kernels_2, avx512::box_kernels_2)();
  return kernels;
}

template<>
const BoxKernels<3> &box_kernels<3>()
{
  static const BoxKernels<3> kernels =
      kernel_for_processor(baseline::box_kernels_3, avx2::box_kernels_3, avx512::box_kernels_3)();
  return kernels;
}
} // namespace amontons
