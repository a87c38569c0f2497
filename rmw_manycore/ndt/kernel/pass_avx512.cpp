// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Kernel for CPUs with AVX-512: sixteen points at a time.

#include "ndt/kernel/pass.hpp"

#if defined(__x86_64__)
#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 warns about intentionally undefined operands in its own header (GCC bug 105593).
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <immintrin.h>

#include <algorithm>
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
  using M = __mmask16;

  static F load(const float * at) { return _mm512_load_ps(at); }
  static float sum(F f) {
    const __m256 eight = _mm256_add_ps(_mm512_castps512_ps256(f), _mm512_extractf32x8_ps(f, 1));
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
  }
  static F set1(float f) { return _mm512_set1_ps(f); }
  static I to_int(F f) { return reinterpret_cast<I>(_mm512_cvttps_epi32(f)); }
  static F to_float(I i) { return _mm512_cvtepi32_ps(reinterpret_cast<__m512i>(i)); }
  static F fma(F a, F b, F c) { return _mm512_fmadd_ps(a, b, c); }
  static F min(F a, F b) { return _mm512_min_ps(a, b); }
  static F max(F a, F b) { return _mm512_max_ps(a, b); }
  static M less_equal(F a, F b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
  static M equal(I a, int32_t i) {
    return _mm512_cmpeq_epi32_mask(reinterpret_cast<__m512i>(a), _mm512_set1_epi32(i));
  }
  static uint32_t bits(M m) { return m; }
  static F only(M m, F f) { return _mm512_maskz_mov_ps(m, f); }
  static F put(F into, M m, F f) { return _mm512_mask_mov_ps(into, m, f); }
  static F shift_exponent(F f, I n) {
    return reinterpret_cast<F>(reinterpret_cast<I>(f) + (n << 23));
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
