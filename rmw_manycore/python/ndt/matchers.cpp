// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// The matchers, alone and with workers: one signature.

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "ndt/matching/serial_matcher.hpp"
#include "ndt/matching/worker_group.hpp"
#include "python/ndt/bindings.hpp"
#include "python/ndt/bound_matcher.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

using Group = Bound<WorkerGroup>;

void prepare(Group & group, const Levels & maps) {
  const nb::gil_scoped_release released;
  group.matcher().prepare(maps);
}

}  // namespace

void bind_matchers(nb::module_ & module) {
  bind_matcher<SerialMatcher>(module, "SerialMatcher")
    .def(nb::init<const MatchOptions &>(), nb::arg("options"));
  bind_matcher<WorkerGroup>(module, "WorkerGroup")
    .def(
      nb::init<const MatchOptions &, const std::string &, const std::vector<int> &>(),
      nb::arg("options"), nb::arg("program"), nb::arg("host_cpus"))
    .def("prepare", &prepare, nb::arg("maps"))
    .def(
      "memory_bytes",
      [](Group & group, size_t points) { return group.matcher().memory_bytes(points); },
      nb::arg("points"))
    .def("pids", [](Group & group) { return group.matcher().pids(); })
    .def("busy_ns", [](Group & group) { return group.matcher().busy_ns(); })
    .def("replaced", [](Group & group) { return group.matcher().replaced(); });
}

}  // namespace manycore::ndt::python
