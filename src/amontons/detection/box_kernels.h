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

/// Sixteen points and the faces' boxes near them.
template<int dim>
struct BoxGroup
{
  static constexpr int most_points = 16, capacity = 512;
  alignas(64) float x[dim][most_points];
  alignas(64) float squared_distances[capacity][most_points]; ///< box by box
  std::uint32_t slots[capacity];                              ///< the boxes
  int n_slots;
};

constexpr std::uint32_t no_slot = ~0U;

template<int dim>
struct BoxKernels
{
  /// Collects the leaves within the bound of the box [low, high]. @return how many; more than `capacity`: too many
  int (*collect)(const BoxTreeView<dim> &tree, const float *low, const float *high, float squared_bound,
                 std::uint32_t *leaves, int capacity);
  /// Of the faces of these leaves those within the bound of the box [low, high], which holds the group's points, and
  /// their distances to each point. @return false if they are too many for a group
  /// @param likeliest null, or for each point the box that probably holds the face closest to it: near, and its centre
  ///        not far either; no_slot where there is none, [most_points]
  bool (*measure)(const BoxTreeView<dim> &tree, const std::uint32_t *leaves, int n_leaves, const float *low,
                  const float *high, float squared_bound, BoxGroup<dim> &group, std::uint32_t *likeliest);
  /// For each box a bit for each point within whose bound it comes.
  /// @param known of each point the box that does not count @param near [n_slots]
  void (*select)(const BoxGroup<dim> &group, const float *squared_bounds, const std::uint32_t *known,
                 std::uint16_t *near);
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
