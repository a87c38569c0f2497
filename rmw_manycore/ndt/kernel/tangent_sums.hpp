// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace manycore::ndt {

/// What one pass adds up over pairs of a point and a voxel it sees, and over points. With q the
/// point turned into the map frame, x the vector from the voxel's mean to it, B the voxel's inverse
/// covariance, f = B x, e = exp(-d2 x'f / 2) and M = e (B - d2 f f'), all in the map frame.
/// The pose appears nowhere: derivatives by roll, pitch and yaw follow from these sums
/// (derivatives.hpp), once per pass and not once per pair.
enum TangentSum : size_t {
  sum_score,     ///< e
  sum_nearest,   ///< the largest e of each point
  sum_pairs,     ///< 1 for each pair
  sum_points,    ///< 1 for each point that sees a voxel
  sum_f,         ///< 3: e f
  sum_fq = 7,    ///< 9: e f q'
  sum_m = 16,    ///< 6: M: xx, xy, xz, yy, yz, zz
  sum_mq = 22,   ///< 9: M [q], column k being M (e_k x q)
  sum_qmq = 31,  ///< 6: [q]' M [q]: xx, xy, xz, yy, yz, zz
  sum_count = 37,
};

/// One bin's sums: whole cache lines. Not alignas(64), which GCC 12 does not keep for temporaries;
/// arrays of them in shared memory are.
struct TangentSums {
  double of[40] = {};
};
static_assert(sizeof(TangentSums) % 64 == 0);

}  // namespace manycore::ndt
