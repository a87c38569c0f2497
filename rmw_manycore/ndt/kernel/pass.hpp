// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ndt/common/pose.hpp"
#include "ndt/kernel/scan.hpp"
#include "ndt/kernel/tangent_sums.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// A pose as the kernel takes it: single precision, relative to the map's origin.
struct PassPose {
  float rotation[9];
  float translation_m[3];
};

PassPose pass_pose(const Pose6 & pose, const MapHeader & map);

/// The hot loops over one bin of a scan. `d2` is the constant of eq. 6.8.
struct Kernel {
  /// All of it: search, and the sums of the derivatives.
  TangentSums (*pass)(
    const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin);
  /// The search alone: the list index of each point of the bin, at the point's place in `found`.
  void (*search)(
    const MapView & map, const ScanView & scan, const PassPose & pose, size_t bin,
    uint32_t * found);
  /// The sums alone, from what a search at the same pose found.
  TangentSums (*derive)(
    const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin,
    const uint32_t * found);
};

enum class Simd { portable, avx2, avx512 };

/// The widest that this CPU has; the environment variable MANYCORE_NDT_SIMD (portable, avx2,
/// avx512) lowers it. Throws Error{invalid_argument} for another word or what the CPU lacks.
Simd choose_simd();
const char * name_of(Simd simd) noexcept;
Kernel kernel_of(Simd simd) noexcept;

/// The same loops compiled for each kind of CPU.
Kernel kernel_portable() noexcept;
Kernel kernel_avx2() noexcept;
Kernel kernel_avx512() noexcept;

}  // namespace manycore::ndt
