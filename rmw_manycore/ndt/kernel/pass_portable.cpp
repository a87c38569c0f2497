// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Kernel for any CPU, with the compiler's vectors of four: SSE2 on x86-64, NEON on ARM.

#include <algorithm>
#include <cstring>

#include "ndt/kernel/pass.hpp"
#include "ndt/map/table.hpp"

namespace manycore::ndt {
namespace portable {

struct Register {
  static constexpr size_t width = 4;
  typedef float F __attribute__((vector_size(16)));
  typedef int32_t I __attribute__((vector_size(16)));
  using M = I;

  static F load(const float * at) {
    F f;
    std::memcpy(&f, at, sizeof f);
    return f;
  }
  static float sum(F f) { return (f[0] + f[2]) + (f[1] + f[3]); }
  static F set1(float f) { return F{f, f, f, f}; }
  static I to_int(F f) { return __builtin_convertvector(f, I); }
  static F to_float(I i) { return __builtin_convertvector(i, F); }
  static F fma(F a, F b, F c) { return a * b + c; }
  static F choose(I mask, F yes, F no) {
    return reinterpret_cast<F>(
      (reinterpret_cast<I>(yes) & mask) | (reinterpret_cast<I>(no) & ~mask));
  }
  static F min(F a, F b) { return choose(a < b, a, b); }
  static F max(F a, F b) { return choose(a > b, a, b); }
  static M less_equal(F a, F b) { return a <= b; }
  static M equal(I a, int32_t i) { return a == i; }
  static uint32_t bits(M m) {
    const I bit = m & I{1, 2, 4, 8};
    return static_cast<uint32_t>(bit[0] | bit[1] | bit[2] | bit[3]);
  }
  static F only(M m, F f) { return reinterpret_cast<F>(reinterpret_cast<I>(f) & m); }
  static F put(F into, M m, F f) { return choose(m, f, into); }
  static F shift_exponent(F f, I n) {
    return reinterpret_cast<F>(reinterpret_cast<I>(f) + (n << 23));
  }
};

#include "ndt/kernel/wide.hpp"

using Lanes = Wide<Wide<Register>>;

#include "ndt/kernel/pass_body.hpp"

}  // namespace portable

Kernel kernel_portable() noexcept {
  return {&portable::pass, &portable::search, &portable::derive};
}

}  // namespace manycore::ndt
