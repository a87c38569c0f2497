// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ndt/common/matrix.hpp"
#include "ndt/common/options.hpp"

namespace manycore::ndt {

/// Mean and scatter of points, accumulated by Welford's method, which avoids large sums.
struct Scatter {
  uint32_t count = 0;
  Vector3 mean{};
  Matrix3 sum{};  ///< of (x - mean)(x - mean)'

  /// Adds one point [m].
  void add(const Vector3 & point);
};

/// Inverse covariance of a voxel. Eigenvalues below 1/100 of the largest are raised to that (eq.
/// 6.11). Empty if the covariance is not positive, as with all points in one place.
std::optional<Matrix3> inverse_covariance(const Scatter & scatter, const MapOptions & options);

}  // namespace manycore::ndt
