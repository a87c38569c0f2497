// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The matchers, alone and with workers: one signature.

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <utility>

#include "bench/ndt/thread_matcher.hpp"
#include "ndt/serial_matcher.hpp"
#include "ndt/worker_group.hpp"
#include "python/ndt/arrays.hpp"
#include "python/ndt/bindings.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

MatchOptions * options(
  StepRule step_rule, uint32_t max_iterations, double step_size, double trans_epsilon,
  double outlier_ratio, double regularization_scale_factor) {
  return new MatchOptions{step_rule,     max_iterations, step_size,
                          trans_epsilon, outlier_ratio,  regularization_scale_factor};
}

template<typename Matcher>
class Bound {
public:
  template<typename... More>
  explicit Bound(const MatchOptions & options, const More &... more)
  : scale_factor_(options.regularization_scale_factor), matcher_(options, more...) {}

  nb::dict align(
    const VoxelMap & map, const FloatPoints & points, const PoseMatrix & guess,
    const std::optional<std::pair<double, double>> & position_m) {
    std::optional<Regularization> regularization;
    if (position_m) {
      regularization = Regularization{scale_factor_, position_m->first, position_m->second};
    }
    return answer([&] {
      return matcher_.align(map, points.data(), points.shape(0), pose_from(guess), regularization);
    });
  }

  nb::dict evaluate(const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose) {
    return answer(
      [&] { return matcher_.evaluate(map, points.data(), points.shape(0), pose_from(pose)); });
  }

  Matcher & matcher() { return matcher_; }

private:
  /// The numbers that `f` finds, without the GIL, and how many points counted.
  template<typename F>
  nb::dict answer(F && f) {
    const auto found = [&] {
      const nb::gil_scoped_release released;
      return f();
    }();
    nb::dict out = to_dict(found);
    out["used_points"] = matcher_.used_points();
    return out;
  }

  double scale_factor_;
  Matcher matcher_;
};

template<typename Matcher>
nb::class_<Bound<Matcher>> bind(nb::module_ & module, const char * name) {
  using Self = Bound<Matcher>;
  return nb::class_<Self>(module, name)
    .def(
      "align", &Self::align, nb::arg("map"), nb::arg("points"), nb::arg("guess"),
      nb::arg("regularization_position_m") = nb::none())
    .def("evaluate", &Self::evaluate, nb::arg("map"), nb::arg("points"), nb::arg("pose"));
}

}  // namespace

void bind_matchers(nb::module_ & module) {
  nb::enum_<StepRule>(module, "StepRule")
    .value("trust_region", StepRule::trust_region)
    .value("clamped", StepRule::clamped)
    .value("more_thuente", StepRule::more_thuente);
  nb::class_<MatchOptions>(module, "MatchOptions")
    .def(
      nb::new_(&options), nb::kw_only(), nb::arg("step_rule"), nb::arg("max_iterations"),
      nb::arg("step_size"), nb::arg("trans_epsilon"), nb::arg("outlier_ratio"),
      nb::arg("regularization_scale_factor"));
  using Serial = Bound<SerialMatcher>;
  bind<SerialMatcher>(module, "SerialMatcher")
    .def(nb::init<const MatchOptions &>(), nb::arg("options"))
    .def(
      "time_passes_ns",
      [](
        Serial & serial, const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose,
        size_t passes) {
        const nb::gil_scoped_release released;
        return serial.matcher().time_passes_ns(
          map, points.data(), points.shape(0), pose_from(pose), passes);
      },
      nb::arg("map"), nb::arg("points"), nb::arg("pose"), nb::arg("passes"))
    .def(
      "time_shares_ns",
      [](
        Serial & serial, const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose,
        size_t workers) {
        const nb::gil_scoped_release released;
        return serial.matcher().time_shares_ns(
          map, points.data(), points.shape(0), pose_from(pose), workers);
      },
      nb::arg("map"), nb::arg("points"), nb::arg("pose"), nb::arg("workers"))
    .def(
      "profile_ns",
      [](
        Serial & serial, const VoxelMap & map, const FloatPoints & points,
        const PoseMatrix & guess) {
        const Profile times =
          serial.matcher().profile(map, points.data(), points.shape(0), pose_from(guess));
        nb::dict out;
        out["lay_out"] = times.lay_out_ns;
        out["search"] = times.search_ns;
        out["derivatives"] = times.derivatives_ns;
        out["total"] = times.total_ns;
        return out;
      },
      nb::arg("map"), nb::arg("points"), nb::arg("guess"));
  bind<ThreadMatcher>(module, "ThreadMatcher")
    .def(
      nb::init<const MatchOptions &, const std::vector<int> &, const std::vector<int> &>(),
      nb::arg("options"), nb::arg("derivative_cpus"), nb::arg("search_cpus"));
  using Group = Bound<WorkerGroup>;
  bind<WorkerGroup>(module, "WorkerGroup")
    .def(
      nb::init<const MatchOptions &, const std::string &, const std::vector<int> &>(),
      nb::arg("options"), nb::arg("program"), nb::arg("host_cpus"))
    .def(
      "prepare",
      [](Group & group, const VoxelMap & map) {
        const nb::gil_scoped_release released;
        group.matcher().prepare(map);
      },
      nb::arg("map"))
    .def(
      "memory_bytes",
      [](Group & group, size_t points) { return group.matcher().memory_bytes(points); },
      nb::arg("points"))
    .def("pids", [](Group & group) { return group.matcher().pids(); })
    .def("busy_ns", [](Group & group) { return group.matcher().busy_ns(); })
    .def("replaced", [](Group & group) { return group.matcher().replaced(); });
}

}  // namespace manycore::ndt::python
