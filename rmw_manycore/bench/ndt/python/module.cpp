// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Bindings used only by benches of the scan matcher; maps, options and results are those of _ndt.

#include <nanobind/nanobind.h>
#include <nanobind/stl/vector.h>

#include "bench/ndt/profiler.hpp"
#include "bench/ndt/thread_matcher.hpp"
#include "python/ndt/bound_matcher.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

using Times = std::vector<double>;

Times time_passes_ns(
  Profiler & profiler, const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose,
  size_t passes) {
  const nb::gil_scoped_release released;
  return profiler.time_passes_ns(map, points.data(), points.shape(0), pose_from(pose), passes);
}

Times time_shares_ns(
  Profiler & profiler, const VoxelMap & map, const FloatPoints & points, const PoseMatrix & pose,
  size_t workers) {
  const nb::gil_scoped_release released;
  return profiler.time_shares_ns(map, points.data(), points.shape(0), pose_from(pose), workers);
}

Profile profile(
  Profiler & profiler, const VoxelMap & map, const FloatPoints & points, const PoseMatrix & guess) {
  const nb::gil_scoped_release released;
  return profiler.profile(map, points.data(), points.shape(0), pose_from(guess));
}

void bind_profiler(nb::module_ & module) {
  nb::class_<Profile>(module, "Profile")
    .def_ro("lay_out_ns", &Profile::lay_out_ns)
    .def_ro("search_ns", &Profile::search_ns)
    .def_ro("derivatives_ns", &Profile::derivatives_ns)
    .def_ro("total_ns", &Profile::total_ns);
  nb::class_<Profiler>(module, "Profiler")
    .def(nb::init<const MatchOptions &>(), nb::arg("options"))
    .def(
      "time_passes_ns", &time_passes_ns, nb::arg("map"), nb::arg("points"), nb::arg("pose"),
      nb::arg("passes"))
    .def(
      "time_shares_ns", &time_shares_ns, nb::arg("map"), nb::arg("points"), nb::arg("pose"),
      nb::arg("workers"))
    .def("profile", &profile, nb::arg("map"), nb::arg("points"), nb::arg("guess"));
}

}  // namespace
}  // namespace manycore::ndt::python

NB_MODULE(_ndt_bench, module) {
  using namespace manycore::ndt;
  module.doc() = "What only benches of the scan matcher use.";
  nb::module_::import_("rmw_manycore_py.native._ndt");
  python::bind_profiler(module);
  python::bind_matcher<ThreadMatcher>(module, "ThreadMatcher")
    .def(
      nb::init<const MatchOptions &, const std::vector<int> &, const std::vector<int> &>(),
      nb::arg("options"), nb::arg("derivative_cpus"), nb::arg("search_cpus"));
}
