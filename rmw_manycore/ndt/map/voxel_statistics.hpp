// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ndt/common/matrix.hpp"
#include "ndt/common/options.hpp"

namespace manycore::ndt {

/// Mean and scatter of points, taken up one after the other (Welford's way: no large sums).
struct Scatter {
  uint32_t count = 0;
  Vector3 mean{};
  Matrix3 sum{};  ///< of (x - mean)(x - mean)'

  void add(const Vector3 & point);
};

/// The inverse covariance of a voxel; eigenvalues below 1/100 of the largest are raised to that
/// (eq. 6.11). Empty when the covariance is not one, as with all points in one place.
std::optional<Matrix3> inverse_covariance(const Scatter & scatter, const MapOptions & options);

}  // namespace manycore::ndt
