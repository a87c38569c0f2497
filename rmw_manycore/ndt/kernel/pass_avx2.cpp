// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Kernel for CPUs with AVX2 and FMA: eight points in a register, two registers at a time.

#include "ndt/kernel/pass.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <algorithm>
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

struct Register {
  static constexpr size_t width = 8;
  typedef float F __attribute__((vector_size(32)));
  typedef int32_t I __attribute__((vector_size(32)));
  using M = F;

  static F load(const float * at) { return _mm256_load_ps(at); }
  static float sum(F f) {
    const __m128 four = _mm_add_ps(_mm256_castps256_ps128(f), _mm256_extractf128_ps(f, 1));
    const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
  }
  static F set1(float f) { return _mm256_set1_ps(f); }
  static I to_int(F f) { return reinterpret_cast<I>(_mm256_cvttps_epi32(f)); }
  static F to_float(I i) { return _mm256_cvtepi32_ps(reinterpret_cast<__m256i>(i)); }
  static F fma(F a, F b, F c) { return _mm256_fmadd_ps(a, b, c); }
  static F min(F a, F b) { return _mm256_min_ps(a, b); }
  static F max(F a, F b) { return _mm256_max_ps(a, b); }
  static M less_equal(F a, F b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
  static M equal(I a, int32_t i) {
    return reinterpret_cast<M>(a == reinterpret_cast<I>(_mm256_set1_epi32(i)));
  }
  static uint32_t bits(M m) { return static_cast<uint32_t>(_mm256_movemask_ps(m)); }
  static F only(M m, F f) { return _mm256_and_ps(m, f); }
  static F put(F into, M m, F f) { return _mm256_blendv_ps(into, f, m); }
  static F shift_exponent(F f, I n) {
    return reinterpret_cast<F>(reinterpret_cast<I>(f) + (n << 23));
  }
};

#include "ndt/kernel/wide.hpp"

using Lanes = Wide<Register>;

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
