// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ndt/common/pose.hpp"
#include "ndt/kernel/scan.hpp"
#include "ndt/kernel/tangent_sums.hpp"
#include "ndt/map/voxel_map.hpp"

namespace manycore::ndt {

/// A pose as used by the kernel: single precision, relative to the map's origin.
struct PassPose {
  float rotation[9];
  float translation_m[3];
};

PassPose pass_pose(const Pose6 & pose, const MapHeader & map);

/// The hot loops over one bin of a scan. `d2` is the constant of eq. 6.8.
struct Kernel {
  /// Voxel search and sums of the derivatives.
  TangentSums (*pass)(
    const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin);
  /// Voxel search only: writes the list index of each point of the bin to `found`, at the point's
  /// index.
  void (*search)(
    const MapView & map, const ScanView & scan, const PassPose & pose, size_t bin,
    uint32_t * found);
  /// Sums only, from the lists that search() found at the same pose.
  TangentSums (*derive)(
    const MapView & map, const ScanView & scan, const PassPose & pose, float d2, size_t bin,
    const uint32_t * found);
};

enum class Simd { portable, avx2, avx512 };

/// Widest instruction set of this CPU; the environment variable MANYCORE_NDT_SIMD (portable, avx2,
/// avx512) lowers it. Throws Error{invalid_argument} for another value or an unsupported set.
Simd choose_simd();
const char * name_of(Simd simd) noexcept;
Kernel kernel_of(Simd simd) noexcept;

/// The same loops, compiled for each instruction set.
Kernel kernel_portable() noexcept;
Kernel kernel_avx2() noexcept;
Kernel kernel_avx512() noexcept;

}  // namespace manycore::ndt
