// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace manycore::ndt {

/// Sums of one pass, over pairs of a point and a voxel in its range, and over points. q is the
/// point rotated into the map frame, x the vector from the voxel's mean to the point, B the voxel's
/// inverse covariance, f = B x, e = exp(-d2 x'f / 2), and M = e (B - d2 f f'), all in the map
/// frame. The sums do not contain the pose: the derivatives by roll, pitch and yaw are computed
/// from them (derivatives.hpp) once per pass instead of once per pair.
enum TangentSum : size_t {
  sum_score,     ///< e
  sum_nearest,   ///< the largest e of each point
  sum_pairs,     ///< 1 for each pair
  sum_points,    ///< 1 for each point with a voxel in range
  sum_f,         ///< 3: e f
  sum_fq = 7,    ///< 9: e f q'
  sum_m = 16,    ///< 6: M: xx, xy, xz, yy, yz, zz
  sum_mq = 22,   ///< 9: M [q], column k being M (e_k x q)
  sum_qmq = 31,  ///< 6: [q]' M [q]: xx, xy, xz, yy, yz, zz
  sum_count = 37,
};

/// Sums of one bin, in whole cache lines. Not alignas(64), which GCC 12 does not honour for
/// temporaries; arrays in shared memory are aligned.
struct TangentSums {
  double of[40] = {};
};
static_assert(sizeof(TangentSums) % 64 == 0);

}  // namespace manycore::ndt
