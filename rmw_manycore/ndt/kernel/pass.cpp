// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/kernel/pass.hpp"

#include <cstdlib>

#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

Simd widest() noexcept {
#if defined(__x86_64__)
  if (
    __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
    __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
    return Simd::avx512;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    return Simd::avx2;
  }
#endif
  return Simd::portable;
}

}  // namespace

const char * name_of(Simd simd) noexcept {
  constexpr const char * names[] = {"portable", "avx2", "avx512"};
  return names[static_cast<size_t>(simd)];
}

Simd choose_simd() {
  const Simd most = widest();
  const char * const wanted = std::getenv("MANYCORE_NDT_SIMD");
  if (wanted == nullptr || *wanted == '\0') {
    return most;
  }
  for (const Simd simd : {Simd::portable, Simd::avx2, Simd::avx512}) {
    if (std::string(name_of(simd)) == wanted && simd <= most) {
      return simd;
    }
  }
  throw Error(
    ErrorCode::invalid_argument,
    "MANYCORE_NDT_SIMD: expected portable, avx2 or avx512, on this CPU at most " +
      std::string(name_of(most)) + ", found '" + wanted + "'");
}

Kernel kernel_of(Simd simd) noexcept {
#if defined(__x86_64__)
  switch (simd) {
    case Simd::avx512:
      return kernel_avx512();
    case Simd::avx2:
      return kernel_avx2();
    case Simd::portable:
      break;
  }
#else
  static_cast<void>(simd);
#endif
  return kernel_portable();
}

PassPose pass_pose(const Pose6 & pose, const MapHeader & map) {
  const Pose4x4 matrix = to_matrix(pose);
  PassPose out{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      out.rotation[3 * i + j] = static_cast<float>(matrix[4 * i + j]);
    }
    out.translation_m[i] = static_cast<float>(matrix[4 * i + 3] - map.origin_m[i]);
  }
  return out;
}

}  // namespace manycore::ndt
