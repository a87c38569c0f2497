// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace manycore::ndt {

/// Points are processed in groups of this size, whatever the register width.
constexpr size_t group_points = 16;

/// Groups are assigned to bins round-robin: bin b has the groups b, b + bin_count, ... A worker
/// processes whole bins, and bins are summed in order, so the result does not depend on the number
/// of workers. 96 is a multiple of 2, 3, 4, 6, 8, 12 and 16; other numbers of workers up to 16 are
/// at most 9 % out of balance.
constexpr size_t bin_count = 96;

/// A scan in the sensor frame, stored by coordinate. The last group is padded with points that no
/// map reaches. 64-byte aligned.
struct ScanView {
  const float * x_m;
  const float * y_m;
  const float * z_m;
  size_t points;  ///< without padding and groups that are not used
  size_t groups;
  size_t used;            ///< number of groups that are used, spread evenly over all
  uint64_t stride = one;  ///< from one used group to the next, in 2^-32

  static constexpr uint64_t one = uint64_t{1} << 32;

  /// Index of a used group, which are numbered from 0.
  size_t group(size_t number) const { return (number * stride) / one; }
  bool is_thinned() const { return used < groups; }
};

/// Number of floats for a scan of this many points.
constexpr size_t scan_floats(size_t points) {
  return 3 * ((points + group_points - 1) / group_points) * group_points;
}

/// Copies those of `count` points (x, y, z [m]) that are finite and within 1e9 m to `floats`, which
/// has room for scan_floats(count). Sorts them in Morton order, so that a group covers few voxels.
ScanView lay_out_scan(const float * xyz_m, size_t count, float * floats);

/// View of the scan that lay_out_scan() left in `floats`, for example from another process.
ScanView view_scan(const float * floats, size_t points);

/// View of about `points` of a whole scan; all of it if they are less than twice as many.
ScanView thinned(const ScanView & scan, size_t points);

}  // namespace manycore::ndt
