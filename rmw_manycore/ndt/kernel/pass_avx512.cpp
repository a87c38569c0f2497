// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Kernel for CPUs with AVX-512: sixteen points at a time, one voxel line per register.

#include "ndt/kernel/pass.hpp"

#if defined(__x86_64__)
#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns about intentionally undefined operands in its own header (GCC bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>

#include <cstring>

#include "ndt/map/table.hpp"

// The functions from here on, and only these, are compiled for AVX-512.
#if defined(__clang__)
#pragma clang attribute push( \
  __attribute__((target("avx512f,avx512dq,avx512vl,avx512bw,avx2,fma"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl,avx512bw,avx2,fma")
#endif

namespace manycore::ndt {
namespace avx512 {

struct Lanes {
  static constexpr size_t width = 16;
  using F = __m512;
  typedef int32_t I __attribute__((vector_size(64)));

  static F load(const float * at) { return _mm512_load_ps(at); }
  static void store(float * at, F f) { _mm512_storeu_ps(at, f); }
  static F set1(float f) { return _mm512_set1_ps(f); }
  static I to_int(F f) { return reinterpret_cast<I>(_mm512_cvttps_epi32(f)); }
  static F to_float(I i) { return _mm512_cvtepi32_ps(reinterpret_cast<__m512i>(i)); }
  static F fma(F a, F b, F c) { return _mm512_fmadd_ps(a, b, c); }
  static F min(F a, F b) { return _mm512_min_ps(a, b); }
  static F max(F a, F b) { return _mm512_max_ps(a, b); }
  static F at_most(F a, F b, F c) {
    return _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(a, b, _CMP_LE_OQ), c);
  }
  static F shift_exponent(F f, I n) {
    return reinterpret_cast<F>(reinterpret_cast<I>(f) + (n << 23));
  }

  /// Four fields of lines i, 4 + i, 8 + i, 12 + i, in this order.
  static F quarter(const float * const (&lines)[width], size_t i, size_t field) {
    __m512 out = _mm512_castps128_ps512(_mm_load_ps(lines[i] + field));
    out = _mm512_insertf32x4(out, _mm_load_ps(lines[4 + i] + field), 1);
    out = _mm512_insertf32x4(out, _mm_load_ps(lines[8 + i] + field), 2);
    return _mm512_insertf32x4(out, _mm_load_ps(lines[12 + i] + field), 3);
  }
  /// Four fields of all lines, transposed, in line order.
  static void load_four(const float * const (&lines)[width], size_t field, F * out) {
    const F a = quarter(lines, 0, field);
    const F b = quarter(lines, 1, field);
    const F c = quarter(lines, 2, field);
    const F d = quarter(lines, 3, field);
    const F ab = _mm512_unpacklo_ps(a, b);
    const F cd = _mm512_unpacklo_ps(c, d);
    out[0] = _mm512_shuffle_ps(ab, cd, 0x44);
    out[1] = _mm512_shuffle_ps(ab, cd, 0xEE);
    const F ab_high = _mm512_unpackhi_ps(a, b);
    const F cd_high = _mm512_unpackhi_ps(c, d);
    out[2] = _mm512_shuffle_ps(ab_high, cd_high, 0x44);
    out[3] = _mm512_shuffle_ps(ab_high, cd_high, 0xEE);
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

}  // namespace avx512

Kernel kernel_avx512() noexcept { return {&avx512::pass, &avx512::search, &avx512::derive}; }

}  // namespace manycore::ndt

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif
