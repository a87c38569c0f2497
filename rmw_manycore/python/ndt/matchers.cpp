// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Bindings of the matchers, serial and with workers; both have the same signature.

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "ndt/matching/serial_matcher.hpp"
#include "ndt/matching/worker_group.hpp"
#include "python/ndt/bindings.hpp"
#include "python/ndt/bound_matcher.hpp"

namespace nb = nanobind;

namespace manycore::ndt::python {
namespace {

using Group = Bound<WorkerGroup>;

void prepare(Group & group, const Maps & maps) {
  const nb::gil_scoped_release released;
  group.matcher().prepare({maps});
}

/// (worker, pass, begin, end) of the last align() or evaluate(); times in ns.
std::vector<std::tuple<size_t, size_t, int64_t, int64_t>> passes(Group & group) {
  std::vector<std::tuple<size_t, size_t, int64_t, int64_t>> rows;
  const auto workers = group.matcher().passes();
  for (size_t worker = 0; worker < workers.size(); ++worker) {
    for (size_t pass = 0; pass < workers[worker].size(); ++pass) {
      rows.emplace_back(worker, pass, workers[worker][pass].begin_ns, workers[worker][pass].end_ns);
    }
  }
  return rows;
}

}  // namespace

void bind_matchers(nb::module_ & module) {
  bind_searcher<SerialMatcher>(module, "SerialMatcher")
    .def(nb::init<const MatchOptions &>(), nb::arg("options"));
  bind_searcher<WorkerGroup>(module, "WorkerGroup")
    .def(
      nb::init<const MatchOptions &, const std::string &, const std::vector<int> &>(),
      nb::arg("options"), nb::arg("program"), nb::arg("host_cpus"))
    .def("prepare", &prepare, nb::arg("maps"))
    .def(
      "memory_bytes",
      [](Group & group, size_t points) { return group.matcher().memory_bytes(points); },
      nb::arg("points"))
    .def("pids", [](Group & group) { return group.matcher().pids(); })
    .def("passes", &passes)
    .def("busy_ns", [](Group & group) { return group.matcher().busy_ns(); })
    .def("replaced", [](Group & group) { return group.matcher().replaced(); });
}

}  // namespace manycore::ndt::python
