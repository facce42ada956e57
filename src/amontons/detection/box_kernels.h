#pragma once
#include <cstddef>
#include <cstdint>

// What the kernels over boxes work on, one set of them per instruction set: plain data, for the sources compiled for
// one instruction set must not define inline functions that others use.
namespace amontons
{
/// Sixteen boxes, single precision.
template<int dim>
struct BoxNode
{
  static constexpr int width = 16;
  alignas(64) float low[dim][width], high[dim][width];
};

/// A BoxTree.
template<int dim>
struct BoxTreeView
{
  const BoxNode<dim> *nodes;      ///< level by level, the leaves first
  const std::size_t *level_begin; ///< in nodes
  int top_level;
};

/// The leaves near a group of points, found once for all of them, so that the way down from the root is shared.
template<int dim>
struct BoxFront
{
  static constexpr int capacity = 64;
  BoxNode<dim> boxes[capacity / BoxNode<dim>::width];
  std::uint32_t leaves[capacity];
  int n_leaves;
};

/// A box in reach of a point.
struct BoxHit
{
  std::uint32_t slot;
  float squared_distance;
  float score; ///< low where the point is near the box's centre, too
};

template<int dim>
struct BoxKernels
{
  /// Collects the leaves within the bound of the box [low, high]. @return false if they are too many for a front
  bool (*collect)(const BoxTreeView<dim> &tree, const float *low, const float *high, float squared_bound,
                  BoxFront<dim> &front);
  /// Boxes of the front's leaves within the bound of x. @return how many; more than `capacity`: not all are in hits,
  /// but the one of lowest score is
  int (*scan)(const BoxTreeView<dim> &tree, const BoxFront<dim> &front, const float *x, float squared_bound,
              BoxHit *hits, int capacity);
  /// Positions along the Hilbert curve (hilbert.h) of n cells, n a multiple of 16, `bits` per axis.
  /// @param cells [dim][n], overwritten
  void (*hilbert)(std::uint32_t *const *cells, int n, int bits, std::uint64_t *positions);
};

namespace baseline
{
BoxKernels<2> box_kernels_2();
BoxKernels<3> box_kernels_3();
} // namespace baseline
#if defined(__x86_64__)
namespace avx2
{
BoxKernels<2> box_kernels_2();
BoxKernels<3> box_kernels_3();
} // namespace avx2
namespace avx512
{
BoxKernels<2> box_kernels_2();
BoxKernels<3> box_kernels_3();
} // namespace avx512
#else
namespace avx2 = baseline;
namespace avx512 = baseline;
#endif

/// Those for this processor.
template<int dim>
const BoxKernels<dim> &box_kernels();
} // namespace amontons
