// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "ndt/common/matrix.hpp"

namespace manycore::ndt {

/// x, y, z [m], roll, pitch, yaw [rad] of T_map_sensor with R = Rx(roll) Ry(pitch) Rz(yaw), the
/// order used by Magnusson's thesis (eq. 6.17), PCL and Autoware.
using Pose6 = Vector6;

/// T_map_sensor, row-major.
using Pose4x4 = std::array<double, 16>;

Pose4x4 to_matrix(const Pose6 & pose);
Pose6 to_pose6(const Pose4x4 & matrix);

/// Rotation axes of roll, pitch and yaw at this pose, in the map frame: with q = R x, dq/d(angle k)
/// = a_k x q, and d2q/d(angle k)d(angle l) = a_k x (a_l x q) for k <= l. Equivalent to eq. 6.18 to
/// 6.21 without their 45 products.
std::array<Vector3, 3> rotation_axes(const Pose6 & pose);

}  // namespace manycore::ndt
