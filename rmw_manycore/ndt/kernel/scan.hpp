// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace manycore::ndt {

/// Points are worked on in groups of this many, whatever the width of the machine's registers.
constexpr size_t group_points = 16;

/// Groups are dealt to bins like cards: bin b has the groups b, b + bin_count, ... A worker does
/// whole bins, and bins are summed in their order, so the result does not depend on the number of
/// workers. 96 is a multiple of 2, 3, 4, 6, 8, 12 and 16 and at most 9 % off for others up to 16.
constexpr size_t bin_count = 96;

/// A scan in the sensor frame, coordinate by coordinate; whole groups, the last one filled up with
/// points that no map reaches. 64-byte aligned.
struct ScanView {
  const float * x_m;
  const float * y_m;
  const float * z_m;
  size_t points;  ///< without the filling
  size_t groups;
};

/// Floats that a scan of so many points takes.
constexpr size_t scan_floats(size_t points) {
  return 3 * ((points + group_points - 1) / group_points) * group_points;
}

/// Lays out those of count points (x, y, z [m]) that are finite and within 1e9 m in `floats`, which
/// has room for scan_floats(count). Neighbours in space become neighbours in memory (Morton order),
/// so that a group sees few voxels.
ScanView lay_out_scan(const float * xyz_m, size_t count, float * floats);

/// The scan that lay_out_scan() left in `floats`, seen from another process.
ScanView view_scan(const float * floats, size_t points);

}  // namespace manycore::ndt
