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

/// Faces and what bounds the distance to each from below: slabs that hold it, one along its axis and some across it.
/// For points over a flat face, or over its edge, the bound is the distance itself.
template<int dim>
struct SlabbedFaces
{
  static constexpr int capacity = 512, n_corners = dim == 2 ? 2 : 4, most_sides = dim == 2 ? 2 : 4;
  static constexpr int stride = capacity + 16; // not a power of two: the rows must not compete for the same cache lines
  std::uint32_t slots[capacity];
  int n, n_sides; ///< sides that count: of a triangle the last does not
  /// Relative to a point near by; a triangle's fourth is its first.
  alignas(64) float corners[n_corners][dim][stride];
  // The rest is made of them, in such a unit that no coordinate is greater than 1. Of a point y of the face: box_low <=
  // y <= box_high, low <= y . axis <= high, y . sides[k] <= ends[k].
  float box_low[dim][stride], box_high[dim][stride];
  float axis[dim][stride], low[stride], high[stride];
  float sides[most_sides][dim][stride], ends[most_sides][stride];
};

/// Sixteen points and the faces near them.
template<int dim>
struct PointGroup
{
  static constexpr int most_points = 16, capacity = SlabbedFaces<dim>::capacity;
  alignas(64) float x[dim][most_points];
  alignas(64) float squared_distances[capacity][most_points]; ///< face by face: not more than these
  std::uint32_t slots[capacity];                              ///< the faces
  int n_slots;
};

constexpr std::uint32_t no_slot = ~0U;

template<int dim>
struct BoxKernels
{
  /// Collects the leaves within the bound of the box [low, high]. @return how many; more than `capacity`: too many
  int (*collect)(const BoxTreeView<dim> &tree, const float *low, const float *high, float squared_bound,
                 std::uint32_t *leaves, int capacity);
  /// The faces of these leaves within the bound of the box [low, high]. @param slots [capacity] @return how many; more
  /// than `capacity`: too many
  int (*list)(const BoxTreeView<dim> &tree, const std::uint32_t *leaves, int n_leaves, const float *low,
              const float *high, float squared_bound, std::uint32_t *slots, int capacity);
  /// Makes slabs about the faces' corners. @param size no coordinate of a point is greater @return the slabs' unit, per
  /// that of the corners
  float (*enclose)(SlabbedFaces<dim> &faces, float size);
  /// Puts those faces into the group whose boxes come within the bound of the box [low, high], which holds the group's
  /// points, and bounds their distances to each point.
  /// @param likeliest null, or for each point the face of least bound, [most_points]; no_slot where there is none
  void (*measure)(const SlabbedFaces<dim> &faces, const float *low, const float *high, float squared_bound,
                  PointGroup<dim> &group, std::uint32_t *likeliest);
  /// For each face a bit for each point within whose bound it comes.
  /// @param known of each point the face that does not count @param near [n_slots]
  void (*select)(const PointGroup<dim> &group, const float *squared_bounds, const std::uint32_t *known,
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
