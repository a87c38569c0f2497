// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "ndt/newton.hpp"
#include "ndt/pose.hpp"

namespace manycore::ndt::python {

using DoublePoints = nanobind::ndarray<
  const double, nanobind::shape<-1, 3>, nanobind::c_contig, nanobind::device::cpu>;
using FloatPoints =
  nanobind::ndarray<const float, nanobind::shape<-1, 3>, nanobind::c_contig, nanobind::device::cpu>;
using PoseMatrix =
  nanobind::ndarray<const double, nanobind::shape<4, 4>, nanobind::c_contig, nanobind::device::cpu>;

Pose6 pose_from(const PoseMatrix & matrix);

/// Score, counts, gradient (6) and hessian (36, row by row) as lists.
nanobind::dict to_dict(const Derivatives & derivatives);
/// The same with the outcome's name, iterations, and the pose as 16 numbers, row by row.
nanobind::dict to_dict(const NewtonResult & result);

}  // namespace manycore::ndt::python
