// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>

#include "ndt/common/pose.hpp"

namespace manycore::ndt::python {

/// Arrays as Python passes them: points (n, 3) in metres, poses (4, 4) row-major.
using DoublePoints = nanobind::ndarray<
  const double, nanobind::shape<-1, 3>, nanobind::c_contig, nanobind::device::cpu>;
using FloatPoints =
  nanobind::ndarray<const float, nanobind::shape<-1, 3>, nanobind::c_contig, nanobind::device::cpu>;
using PoseMatrix =
  nanobind::ndarray<const double, nanobind::shape<4, 4>, nanobind::c_contig, nanobind::device::cpu>;

inline Pose6 pose_from(const PoseMatrix & matrix) {
  Pose4x4 rows;
  std::copy_n(matrix.data(), rows.size(), rows.begin());
  return to_pose6(rows);
}

}  // namespace manycore::ndt::python
