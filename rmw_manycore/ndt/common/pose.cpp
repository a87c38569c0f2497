// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/common/pose.hpp"

#include <algorithm>

namespace manycore::ndt {

Pose4x4 to_matrix(const Pose6 & pose) {
  const double cx = std::cos(pose[3]), sx = std::sin(pose[3]);
  const double cy = std::cos(pose[4]), sy = std::sin(pose[4]);
  const double cz = std::cos(pose[5]), sz = std::sin(pose[5]);
  // clang-format off
  return {
    cy * cz,                -cy * sz,               sy,       pose[0],
    cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy, pose[1],
    sx * sz - cx * sy * cz, cx * sy * sz + sx * cz, cx * cy,  pose[2],
    0,                      0,                      0,        1};
  // clang-format on
}

Pose6 to_pose6(const Pose4x4 & m) {
  const double pitch = std::asin(std::clamp(m[2], -1.0, 1.0));
  return {m[3], m[7], m[11], std::atan2(-m[6], m[10]), pitch, std::atan2(-m[1], m[0])};
}

std::array<Vector3, 3> rotation_axes(const Pose6 & pose) {
  const double cx = std::cos(pose[3]), sx = std::sin(pose[3]);
  const double cy = std::cos(pose[4]), sy = std::sin(pose[4]);
  return {Vector3{1, 0, 0}, Vector3{0, cx, sx}, Vector3{sy, -sx * cy, cx * cy}};
}

}  // namespace manycore::ndt
