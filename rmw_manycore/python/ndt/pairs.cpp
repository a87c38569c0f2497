// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Bindings of a pass in parts: search, sums, and Newton's method over sums from elsewhere.
#include "ndt/kernel/pairs.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/pair.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "ndt/optimisation/newton.hpp"
#include "platform/error.hpp"
#include "python/ndt/arrays.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

using Counts = nb::ndarray<const uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using PairRows = nb::ndarray<const float, nb::shape<-1, 12>, nb::c_contig, nb::device::cpu>;
using Sums = nb::ndarray<const double, nb::shape<sum_count>, nb::c_contig, nb::device::cpu>;
using SumsAt = std::function<Sums(nb::object)>;

std::pair<nb::object, nb::object> search(
  const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose) {
  const auto found = std::make_unique<Pairs>();
  {
    const nb::gil_scoped_release released;
    *found = search_pairs(map.view(), pose_from(pose), points.data(), points.shape(0));
  }
  using OutCounts = nb::ndarray<nb::numpy, const uint8_t, nb::ndim<1>>;
  using OutPairs = nb::ndarray<nb::numpy, const float, nb::shape<-1, 12>, nb::c_contig>;
  const auto * const floats = reinterpret_cast<const float *>(found->pairs.data());
  return {
    OutCounts(found->counts.data(), {found->counts.size()}).cast(nb::rv_policy::copy),
    OutPairs(floats, {found->pairs.size(), 12}).cast(nb::rv_policy::copy)};
}

nb::object sum(
  const Counts & counts, const PairRows & pairs, double outlier_ratio, double voxel_size_m) {
  size_t expected = 0;
  for (size_t i = 0; i < counts.shape(0); ++i) {
    expected += counts.data()[i];
  }
  if (expected != pairs.shape(0)) {
    throw Error(
      ErrorCode::invalid_argument, "pairs: expected " + std::to_string(expected) +
                                     ", the sum of the counts, found " +
                                     std::to_string(pairs.shape(0)));
  }
  TangentSums sums;
  {
    const nb::gil_scoped_release released;
    const auto * const first = reinterpret_cast<const Pair *>(pairs.data());
    const double d2 = gaussian(outlier_ratio, voxel_size_m).d2;
    sums = sums_of_pairs(counts.data(), counts.shape(0), first, d2);
  }
  using Out = nb::ndarray<nb::numpy, const double, nb::shape<sum_count>, nb::c_contig>;
  return Out(sums.of, {sum_count}).cast(nb::rv_policy::copy);
}

Derivatives derivatives_at(
  const Sums & sums, const PoseMatrix & pose, double outlier_ratio, double voxel_size_m) {
  TangentSums all;
  std::copy_n(sums.data(), size_t{sum_count}, all.of);
  return derivatives(all, gaussian(outlier_ratio, voxel_size_m), pose_from(pose));
}

nb::object matrix_of(const Pose6 & pose) {
  using View = nb::ndarray<nb::numpy, const double, nb::shape<4, 4>, nb::c_contig>;
  const Pose4x4 matrix = to_matrix(pose);
  return View(matrix.data(), {4, 4}).cast(nb::rv_policy::copy);
}

NewtonResult maximise_sums(
  const MatchOptions & options, double voxel_size_m, const PoseMatrix & guess,
  const SumsAt & sums_at) {
  const Gaussian constants = gaussian(options.outlier_ratio, voxel_size_m);
  return maximise(pose_from(guess), options, [&](const Pose6 & pose) {
    TangentSums all;
    std::copy_n(sums_at(matrix_of(pose)).data(), size_t{sum_count}, all.of);
    return derivatives(all, constants, pose);
  });
}

}  // namespace

void bind_pairs(nb::module_ & module) {
  module.def("search_pairs", &search, nb::arg("map"), nb::arg("points"), nb::arg("pose"));
  module.def(
    "sums_of_pairs", &sum, nb::arg("counts"), nb::arg("pairs"), nb::arg("outlier_ratio"),
    nb::arg("voxel_size_m"));
  module.def(
    "derivatives_at", &derivatives_at, nb::arg("sums"), nb::arg("pose"), nb::arg("outlier_ratio"),
    nb::arg("voxel_size_m"));
  module.def(
    "maximise_sums", &maximise_sums, nb::arg("options"), nb::arg("voxel_size_m"), nb::arg("guess"),
    nb::arg("sums_at"));
}

}  // namespace manycore::ndt::python
