// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/kernel/pairs.hpp"

#include <algorithm>
#include <cmath>

#include "ndt/kernel/pass.hpp"
#include "ndt/map/table.hpp"

namespace manycore::ndt {
namespace {

double full(const float * symmetric, size_t row, size_t column) {
  constexpr size_t index[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  return static_cast<double>(symmetric[index[row][column]]);
}

/// One pair's vectors in double precision.
struct Terms {
  double q[3];
  double f[3];     // B x
  double m[3][3];  // M / e
  double e;
};

Terms terms_of(const Pair & pair, double d2) {
  Terms t{};
  double distance = 0;
  for (size_t i = 0; i < 3; ++i) {
    t.q[i] = static_cast<double>(pair.q_m[i]);
    for (size_t j = 0; j < 3; ++j) {
      t.f[i] += full(pair.inverse_covariance, i, j) * static_cast<double>(pair.x_m[j]);
    }
    distance += t.f[i] * static_cast<double>(pair.x_m[i]);
  }
  t.e = std::exp(-0.5 * d2 * distance);
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      t.m[i][j] = full(pair.inverse_covariance, i, j) - d2 * t.f[i] * t.f[j];
    }
  }
  return t;
}

/// row [q]: the cross products of a row with q.
Vector3 turned(const Vector3 & row, const double (&q)[3]) {
  return {
    row[2] * q[1] - row[1] * q[2], row[0] * q[2] - row[2] * q[0], row[1] * q[0] - row[0] * q[1]};
}

void add(const Terms & t, TangentSums & sums) {
  sums.of[sum_score] += t.e;
  sums.of[sum_pairs] += 1;
  Vector3 mq[3];
  size_t next = 0;
  for (size_t i = 0; i < 3; ++i) {
    mq[i] = turned({t.e * t.m[i][0], t.e * t.m[i][1], t.e * t.m[i][2]}, t.q);
    sums.of[sum_f + i] += t.e * t.f[i];
    for (size_t j = 0; j < 3; ++j) {
      sums.of[sum_fq + 3 * i + j] += t.e * t.f[i] * t.q[j];
      sums.of[sum_mq + 3 * i + j] += mq[i][j];
    }
    for (size_t j = i; j < 3; ++j, ++next) {
      sums.of[sum_m + next] += t.e * t.m[i][j];
    }
  }
  next = 0;
  for (size_t j = 0; j < 3; ++j) {
    const Vector3 column = turned({mq[0][j], mq[1][j], mq[2][j]}, t.q);
    for (size_t i = j; i < 3; ++i, ++next) {
      sums.of[sum_qmq + next] += column[i];
    }
  }
}

}  // namespace

Pairs search_pairs(const MapView & map, const Pose6 & pose, const float * xyz_m, size_t count) {
  const PassPose at = pass_pose(pose, *map.header);
  const auto size_m = static_cast<float>(map.header->voxel_size_m);
  Pairs out;
  out.counts.resize(count);
  for (size_t point = 0; point < count; ++point) {
    const float * const p = xyz_m + 3 * point;
    if (!(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) {
      continue;
    }
    Pair pair{};
    float place_m[3];
    for (size_t i = 0; i < 3; ++i) {
      const float * const row = at.rotation + 3 * i;
      pair.q_m[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
      place_m[i] = pair.q_m[i] + at.translation_m[i];
    }
    for (const uint32_t * line = voxels_at(map, place_m); *line != 0; ++line) {
      const VoxelLine & voxel = map.lines[*line];
      float squared_m = 0;
      for (size_t i = 0; i < 3; ++i) {
        pair.x_m[i] = place_m[i] - voxel.mean_m[i];
        squared_m += pair.x_m[i] * pair.x_m[i];
      }
      if (map.header->search == Search::radius && squared_m > size_m * size_m) {
        continue;
      }
      std::copy_n(voxel.inverse_covariance, 6, pair.inverse_covariance);
      out.pairs.push_back(pair);
      ++out.counts[point];
    }
  }
  return out;
}

TangentSums sums_of_pairs(const uint8_t * counts, size_t count, const Pair * pairs, double d2) {
  TangentSums sums;
  for (size_t point = 0; point < count; ++point) {
    double nearest = 0;
    for (size_t i = 0; i < counts[point]; ++i) {
      const Terms terms = terms_of(*pairs++, d2);
      add(terms, sums);
      nearest = std::max(nearest, terms.e);
    }
    sums.of[sum_nearest] += nearest;
    sums.of[sum_points] += counts[point] > 0 ? 1 : 0;
  }
  return sums;
}

}  // namespace manycore::ndt
