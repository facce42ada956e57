#pragma once
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

// Sources that include this are compiled once per instruction set, each in a namespace of its own, so that no code for
// a newer processor can stand in for the same inline function elsewhere.
#ifndef AMONTONS_INSTRUCTION_SET
#define AMONTONS_INSTRUCTION_SET baseline
#endif

namespace amontons::AMONTONS_INSTRUCTION_SET
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
constexpr int vector_bytes = 64;
#elif defined(__AVX__)
constexpr int vector_bytes = 32;
#else
constexpr int vector_bytes = 16;
#endif

/// As many doubles as a register holds. Formulas written for any of double and Lanes give the same bits for both and
/// on every instruction set, as each operation rounds alike (contraction to fused multiply-add is off).
using Lanes = double __attribute__((vector_size(vector_bytes)));
using FloatLanes = float __attribute__((vector_size(vector_bytes)));
constexpr int n_lanes = vector_bytes / 8, n_float_lanes = vector_bytes / 4;

/// What a comparison of them gives: per lane all bits set, or none.
using LaneMask = std::int64_t __attribute__((vector_size(vector_bytes)));
using FloatLaneMask = std::int32_t __attribute__((vector_size(vector_bytes)));

#define AMONTONS_INLINE [[gnu::always_inline]] inline

template<typename Vector, typename Scalar>
AMONTONS_INLINE Vector load(const Scalar *from)
{
  Vector result;
  std::memcpy(&result, from, sizeof(Vector));
  return result;
}
template<typename Vector, typename Scalar>
AMONTONS_INLINE void store(const Vector &vector, Scalar *to)
{
  std::memcpy(to, &vector, sizeof(Vector));
}

/// One bit per lane.
AMONTONS_INLINE std::uint32_t bits(const LaneMask &mask)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_movepi64_mask(reinterpret_cast<const __m512i &>(mask));
#elif defined(__AVX__)
  return static_cast<std::uint32_t>(_mm256_movemask_pd(reinterpret_cast<const __m256d &>(mask)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_pd(reinterpret_cast<const __m128d &>(mask)));
#else
  return (mask[0] ? 1U : 0U) | (mask[1] ? 2U : 0U);
#endif
}
AMONTONS_INLINE std::uint32_t bits(const FloatLaneMask &mask)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return _mm512_movepi32_mask(reinterpret_cast<const __m512i &>(mask));
#elif defined(__AVX__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<const __m256 &>(mask)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<const __m128 &>(mask)));
#else
  return (mask[0] ? 1U : 0U) | (mask[1] ? 2U : 0U) | (mask[2] ? 4U : 0U) | (mask[3] ? 8U : 0U);
#endif
}

AMONTONS_INLINE bool any(const LaneMask &mask)
{
  return bits(mask) != 0;
}
AMONTONS_INLINE bool any(bool mask)
{
  return mask;
}

/// Square root, correctly rounded everywhere.
AMONTONS_INLINE double root(double a)
{
  return __builtin_sqrt(a);
}
AMONTONS_INLINE Lanes root(const Lanes &a)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return reinterpret_cast<Lanes>(_mm512_maskz_sqrt_pd(0xFF, reinterpret_cast<const __m512d &>(a)));
#elif defined(__AVX__)
  return reinterpret_cast<Lanes>(_mm256_sqrt_pd(reinterpret_cast<const __m256d &>(a)));
#elif defined(__SSE2__)
  return reinterpret_cast<Lanes>(_mm_sqrt_pd(reinterpret_cast<const __m128d &>(a)));
#else
  Lanes result = a;
  for (int i = 0; i < n_lanes; ++i)
    result[i] = __builtin_sqrt(a[i]);
  return result;
#endif
}

AMONTONS_INLINE FloatLanes root(const FloatLanes &a)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return reinterpret_cast<FloatLanes>(_mm512_maskz_sqrt_ps(0xFFFF, reinterpret_cast<const __m512 &>(a)));
#elif defined(__AVX__)
  return reinterpret_cast<FloatLanes>(_mm256_sqrt_ps(reinterpret_cast<const __m256 &>(a)));
#elif defined(__SSE2__)
  return reinterpret_cast<FloatLanes>(_mm_sqrt_ps(reinterpret_cast<const __m128 &>(a)));
#else
  FloatLanes result = a;
  for (int i = 0; i < n_float_lanes; ++i)
    result[i] = __builtin_sqrtf(a[i]);
  return result;
#endif
}

template<typename Real>
AMONTONS_INLINE Real least(const Real &a, const Real &b)
{
  return a < b ? a : b;
}
template<typename Real>
AMONTONS_INLINE Real greatest(const Real &a, const Real &b)
{
  return a > b ? a : b;
}
template<typename Real>
AMONTONS_INLINE Real magnitude(const Real &a)
{
  return greatest<Real>(a, -a);
}
} // namespace amontons::AMONTONS_INSTRUCTION_SET
