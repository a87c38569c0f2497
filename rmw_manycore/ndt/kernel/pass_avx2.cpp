// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Kernel for CPUs with AVX2 and FMA: eight points at a time.

#include "ndt/kernel/pass.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <cstring>

#include "ndt/map/table.hpp"

// The functions from here on, and only these, are compiled for AVX2.
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma")
#endif

namespace manycore::ndt {
namespace avx2 {

struct Lanes {
  static constexpr size_t width = 8;
  using F = __m256;
  typedef int32_t I __attribute__((vector_size(32)));

  static F load(const float * at) { return _mm256_load_ps(at); }
  static void store(float * at, F f) { _mm256_storeu_ps(at, f); }
  static F set1(float f) { return _mm256_set1_ps(f); }
  static I to_int(F f) { return reinterpret_cast<I>(_mm256_cvttps_epi32(f)); }
  static F to_float(I i) { return _mm256_cvtepi32_ps(reinterpret_cast<__m256i>(i)); }
  static F fma(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
  static F min(F a, F b) { return _mm256_min_ps(a, b); }
  static F max(F a, F b) { return _mm256_max_ps(a, b); }
  static F at_most(F a, F b, F c) { return _mm256_and_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ), c); }
  static F shift_exponent(F f, I n) {
    return reinterpret_cast<F>(reinterpret_cast<I>(f) + (n << 23));
  }

  /// Four fields of lines i and 4 + i, in this order.
  static F half(const float * const (&lines)[width], size_t i, size_t field) {
    const __m256 low = _mm256_castps128_ps256(_mm_load_ps(lines[i] + field));
    return _mm256_insertf128_ps(low, _mm_load_ps(lines[4 + i] + field), 1);
  }
  /// Four fields of all lines, transposed, in line order.
  static void load_four(const float * const (&lines)[width], size_t field, F * out) {
    const F a = half(lines, 0, field);
    const F b = half(lines, 1, field);
    const F c = half(lines, 2, field);
    const F d = half(lines, 3, field);
    const F ab = _mm256_unpacklo_ps(a, b);
    const F cd = _mm256_unpacklo_ps(c, d);
    out[0] = _mm256_shuffle_ps(ab, cd, 0x44);
    out[1] = _mm256_shuffle_ps(ab, cd, 0xEE);
    const F ab_high = _mm256_unpackhi_ps(a, b);
    const F cd_high = _mm256_unpackhi_ps(c, d);
    out[2] = _mm256_shuffle_ps(ab_high, cd_high, 0x44);
    out[3] = _mm256_shuffle_ps(ab_high, cd_high, 0xEE);
  }

  template<size_t fields>
  static void load_lines(const float * const (&lines)[width], F (&out)[fields]) {
    F all[(fields + 3) / 4 * 4];
    for (size_t field = 0; field < fields; field += 4) {
      load_four(lines, field, all + field);
    }
    for (size_t field = 0; field < fields; ++field) {
      out[field] = all[field];
    }
  }
};

#include "ndt/kernel/pass_body.hpp"

}  // namespace avx2

Kernel kernel_avx2() noexcept { return {&avx2::pass, &avx2::search, &avx2::derive}; }

}  // namespace manycore::ndt

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
