// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ndt/pose.hpp"
#include "ndt/scan.hpp"
#include "ndt/tangent_sums.hpp"
#include "ndt/voxel_map.hpp"

namespace manycore::ndt {

/// A pose as the kernel takes it: single precision, relative to the map's origin.
struct PassPose {
  float rotation[9];
  float translation_m[3];
};

PassPose pass_pose(const Pose6 & pose, const MapHeader & map);

/// Sums of one bin of the scan. `d2` is the constant of eq. 6.8.
using BinPass = TangentSums (*)(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin);

enum class Simd { portable, avx2, avx512 };

/// The widest that this CPU has; the environment variable MANYCORE_NDT_SIMD (portable, avx2, avx512)
/// lowers it. Throws Error{invalid_argument} for another word or what the CPU lacks.
Simd choose_simd();
const char * name_of(Simd simd) noexcept;
BinPass bin_pass(Simd simd) noexcept;

/// The same function compiled for each kind of CPU.
TangentSums bin_pass_portable(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin);
TangentSums bin_pass_avx2(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin);
TangentSums bin_pass_avx512(
  const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin);

}  // namespace manycore::ndt
