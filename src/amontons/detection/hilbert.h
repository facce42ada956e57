#pragma once
#include <array>
#include <cstdint>

namespace amontons
{
/// Position along the Hilbert curve of a cell of a cube of 2^bits cells a side (Skilling 2004, AIP Conf. Proc. 707: the
/// coordinates are turned in place into the bits of the position, axis by axis).
template<int dim, int bits>
std::uint64_t hilbert_position(std::array<std::uint32_t, dim> x)
{
  static_assert(dim * bits <= 64);
  for (std::uint32_t level = 1U << (bits - 1); level > 1; level >>= 1)
  {
    const std::uint32_t below = level - 1;
    for (int c = 0; c < dim; ++c)
      if (x[c] & level)
        x[0] ^= below;
      else
      {
        const std::uint32_t differ = (x[0] ^ x[c]) & below;
        x[0] ^= differ;
        x[c] ^= differ;
      }
  }
  for (int c = 1; c < dim; ++c)
    x[c] ^= x[c - 1];
  std::uint32_t flip = 0;
  for (std::uint32_t level = 1U << (bits - 1); level > 1; level >>= 1)
    if (x[dim - 1] & level)
      flip ^= level - 1;
  std::uint64_t position = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    for (int c = 0; c < dim; ++c)
      position = position << 1 | (((x[c] ^ flip) >> bit) & 1U);
  return position;
}
} // namespace amontons
