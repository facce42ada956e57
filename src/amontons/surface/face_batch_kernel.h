#pragma once
#include <cstdint>

namespace amontons
{
/// What the kernels of FaceBatch work on; here, apart, for the sources compiled for one instruction set must not define
/// inline functions that others use.
struct FaceBatchView
{
  static constexpr int capacity = 64;
  const double (*corners)[capacity]; ///< [n_nodes * dim], relative to the point
  double *s, *t, *squared_distance;
  double *gap; ///< null: not asked for
  int n_nodes, n;
};

/// @return a bit for each face of which the result is not proven
using FaceBatchKernel = std::uint64_t (*)(const FaceBatchView &);

namespace baseline
{
std::uint64_t project_batch(const FaceBatchView &batch);
}
#if defined(__x86_64__)
namespace avx2
{
std::uint64_t project_batch(const FaceBatchView &batch);
}
namespace avx512
{
std::uint64_t project_batch(const FaceBatchView &batch);
}
#else
namespace avx2 = baseline;
namespace avx512 = baseline;
#endif
} // namespace amontons
