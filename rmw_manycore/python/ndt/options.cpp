// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/common/options.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "python/ndt/bindings.hpp"
#include "python/ndt/words.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

using manycore::python::from_word;

void init_map_options(
  MapOptions * options, double voxel_size_m, const std::string & search,
  const std::string & covariance, uint32_t min_points_per_voxel, double widening_m) {
  new (options) MapOptions{
    voxel_size_m, from_word<Search>(search), from_word<VoxelCovariance>(covariance),
    min_points_per_voxel, widening_m};
}

void init_match_options(
  MatchOptions * options, const std::string & step_rule, uint32_t max_iterations, double step_size,
  double trans_epsilon, double outlier_ratio, double regularization_scale_factor) {
  new (options) MatchOptions{
    from_word<StepRule>(step_rule), max_iterations, step_size, trans_epsilon, outlier_ratio,
    regularization_scale_factor};
}

}  // namespace

void bind_options(nb::module_ & module) {
  nb::class_<MapOptions>(module, "MapOptions")
    .def(
      "__init__", &init_map_options, nb::kw_only(), nb::arg("voxel_size_m"), nb::arg("search"),
      nb::arg("covariance"), nb::arg("min_points_per_voxel"), nb::arg("widening_m"));
  nb::class_<MatchOptions>(module, "MatchOptions")
    .def(
      "__init__", &init_match_options, nb::kw_only(), nb::arg("step_rule"),
      nb::arg("max_iterations"), nb::arg("step_size"), nb::arg("trans_epsilon"),
      nb::arg("outlier_ratio"), nb::arg("regularization_scale_factor"));
}

}  // namespace manycore::ndt::python
