// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/serial_matcher.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include "ndt/python/arrays.hpp"
#include "ndt/python/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

std::optional<Regularization> regularization_of(
  const MatchOptions & options, const std::optional<std::pair<double, double>> & position_m) {
  if (!position_m) {
    return std::nullopt;
  }
  return Regularization{options.regularization_scale_factor, position_m->first, position_m->second};
}

class BoundSerialMatcher {
public:
  explicit BoundSerialMatcher(const MatchOptions & options) : options_(options), matcher_(options) {}

  nb::dict align(
    const VoxelMap & map, const FloatPoints & points, const PoseMatrix & guess,
    const std::optional<std::pair<double, double>> & regularization_position_m) {
    NewtonResult result{};
    {
      const nb::gil_scoped_release released;
      result = matcher_.align(
        map, points.data(), points.shape(0), pose_from(guess),
        regularization_of(options_, regularization_position_m));
    }
    return to_dict(result);
  }

  nb::dict evaluate(const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose) {
    Derivatives result;
    {
      const nb::gil_scoped_release released;
      result = matcher_.evaluate(map, points.data(), points.shape(0), pose_from(pose));
    }
    return to_dict(result);
  }

private:
  MatchOptions options_;
  SerialMatcher matcher_;
};

MatchOptions * options(
  StepRule step_rule, uint32_t max_iterations, double step_size, double trans_epsilon,
  double outlier_ratio, double regularization_scale_factor) {
  return new MatchOptions{step_rule,     max_iterations, step_size,
                          trans_epsilon, outlier_ratio,  regularization_scale_factor};
}

}  // namespace

void bind_serial_matcher(nb::module_ & module) {
  nb::enum_<StepRule>(module, "StepRule")
    .value("clamped", StepRule::clamped)
    .value("more_thuente", StepRule::more_thuente);
  nb::class_<MatchOptions>(module, "MatchOptions")
    .def(nb::new_(&options), nb::kw_only(), nb::arg("step_rule"), nb::arg("max_iterations"),
         nb::arg("step_size"), nb::arg("trans_epsilon"), nb::arg("outlier_ratio"),
         nb::arg("regularization_scale_factor"));
  nb::class_<BoundSerialMatcher>(module, "SerialMatcher")
    .def(nb::init<const MatchOptions &>(), nb::arg("options"))
    .def("align", &BoundSerialMatcher::align, nb::arg("map"), nb::arg("points"), nb::arg("guess"),
         nb::arg("regularization_position_m") = nb::none())
    .def("evaluate", &BoundSerialMatcher::evaluate, nb::arg("map"), nb::arg("points"),
         nb::arg("pose"));
}

}  // namespace manycore::ndt::python
