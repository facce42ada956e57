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

/// The boxes near a group of points, found once for all of them; each box is then held against all points at once.
template<int dim>
struct BoxFront
{
  static constexpr int most_points = 16, capacity = 512;
  alignas(64) float x[dim][most_points];
  alignas(64) float squared_bounds[most_points]; ///< negative: nothing is within it
  std::uint32_t slots[capacity];                 ///< the boxes
  int n_slots;
};

/// A box in reach of a point.
struct BoxHit
{
  std::uint32_t slot;
  float squared_distance;
};
constexpr std::uint32_t no_slot = ~0U;

template<int dim>
struct BoxKernels
{
  /// Collects the boxes within the bound of the box [low, high]. @return false if they are too many for a front
  bool (*collect)(const BoxTreeView<dim> &tree, const float *low, const float *high, float squared_bound,
                  BoxFront<dim> &front);
  /// For each point the box that probably holds the face closest to it: near, and its centre not far either; no_slot
  /// where none of the front is within its bound.
  void (*likeliest)(const BoxTreeView<dim> &tree, const BoxFront<dim> &front, std::uint32_t *slots);
  /// Boxes of the front within each point's bound.
  /// @param hits [most_points], for each point room for `capacity` @param n_hits how many; where more than `capacity`,
  ///        the first of them are in hits
  void (*scan)(const BoxTreeView<dim> &tree, const BoxFront<dim> &front, BoxHit *const *hits, int capacity,
               int *n_hits);
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
