// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/map/voxel_statistics.hpp"

#include <algorithm>

namespace manycore::ndt {
namespace {

constexpr double min_eigenvalue_ratio = 0.01;

Matrix3 covariance(const Scatter & scatter, const MapOptions & options) {
  const VoxelCovariance kind = options.covariance;
  const double n = scatter.count;
  const double start = kind == VoxelCovariance::pcl ? 0.0 : 1.0;
  const double factor = kind == VoxelCovariance::pclomp ? (n - 1) / (n * n) : 1 / (n - 1);
  Matrix3 out = scatter.sum;
  for (size_t i = 0; i < 3; ++i) {
    out[i][i] += start;
    for (double & element : out[i]) {
      element *= factor;
    }
    out[i][i] += options.widening_m * options.widening_m;
  }
  return out;
}

}  // namespace

void Scatter::add(const Vector3 & point) {
  ++count;
  Vector3 before;
  for (size_t i = 0; i < 3; ++i) {
    before[i] = point[i] - mean[i];
    mean[i] += before[i] / count;
  }
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      sum[i][j] += before[i] * (point[j] - mean[j]);
    }
  }
}

std::optional<Matrix3> inverse_covariance(const Scatter & scatter, const MapOptions & options) {
  const Eigen<3> eigen = symmetric_eigen(covariance(scatter, options));
  const double largest = *std::max_element(eigen.values.begin(), eigen.values.end());
  if (!(largest > 0) || !std::isfinite(1 / (min_eigenvalue_ratio * largest))) {
    return std::nullopt;
  }
  return eigen.map(
    [&](double value) { return 1 / std::max(value, min_eigenvalue_ratio * largest); });
}

}  // namespace manycore::ndt
