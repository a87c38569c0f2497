// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Two registers as one of twice the width. Included by pass_<simd>.cpp before pass_body.hpp, whose
// operations it has. Passed by reference, since registers in structs have no stable ABI by value.

/// A pair of registers of floats, integers or masks.
template<typename Half>
struct Two {
  Half low;
  Half high;

  Two operator+(const Two & b) const { return {low + b.low, high + b.high}; }
  Two operator-(const Two & b) const { return {low - b.low, high - b.high}; }
  Two operator*(const Two & b) const { return {low * b.low, high * b.high}; }
  Two operator*(int32_t b) const { return {low * b, high * b}; }
  Two operator-() const { return {-low, -high}; }
  Two & operator+=(const Two & b) { return *this = *this + b; }
};

template<typename Half>
struct Wide {
  static constexpr size_t width = 2 * Half::width;
  using F = Two<typename Half::F>;
  using I = Two<typename Half::I>;
  using M = Two<typename Half::M>;

  static F load(const float * at) { return {Half::load(at), Half::load(at + Half::width)}; }
  static float sum(const F & f) { return Half::sum(f.low + f.high); }
  static F set1(float f) { return {Half::set1(f), Half::set1(f)}; }
  static I to_int(const F & f) { return {Half::to_int(f.low), Half::to_int(f.high)}; }
  static F to_float(const I & i) { return {Half::to_float(i.low), Half::to_float(i.high)}; }
  static F fma(const F & a, const F & b, const F & c) {
    return {Half::fma(a.low, b.low, c.low), Half::fma(a.high, b.high, c.high)};
  }
  static F min(const F & a, const F & b) {
    return {Half::min(a.low, b.low), Half::min(a.high, b.high)};
  }
  static F max(const F & a, const F & b) {
    return {Half::max(a.low, b.low), Half::max(a.high, b.high)};
  }
  static M less_equal(const F & a, const F & b) {
    return {Half::less_equal(a.low, b.low), Half::less_equal(a.high, b.high)};
  }
  static M equal(const I & a, int32_t i) { return {Half::equal(a.low, i), Half::equal(a.high, i)}; }
  static uint32_t bits(const M & m) {
    return Half::bits(m.low) | Half::bits(m.high) << Half::width;
  }
  static F only(const M & m, const F & f) {
    return {Half::only(m.low, f.low), Half::only(m.high, f.high)};
  }
  static F put(const F & into, const M & m, const F & f) {
    return {Half::put(into.low, m.low, f.low), Half::put(into.high, m.high, f.high)};
  }
  static F shift_exponent(const F & f, const I & n) {
    return {Half::shift_exponent(f.low, n.low), Half::shift_exponent(f.high, n.high)};
  }
};
