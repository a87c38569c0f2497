// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Bindings to control the tracing of a platform from outside, and to save its events.

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <unistd.h>

#include <memory>

#include "python/context.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/text.hpp"
#include "transport/lifecycle/trace_control.hpp"
#include "transport/lifecycle/trace_saver.hpp"
#include "transport/registry/smem_charge.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

void start(
  const std::string & platform, const std::vector<uint32_t> & clusters,
  const std::vector<std::string> & nodes, uint32_t events, bool discard) {
  const nb::gil_scoped_release released;
  Registry registry(PlatformPaths::of(platform));
  if (discard && trace_state(registry).started_ns == 0) {  // never discards a running trace
    discard_trace(registry);
  }
  start_trace(registry, {clusters, nodes, events});
}

void stop(const std::string & platform) {
  Registry registry(PlatformPaths::of(platform));
  stop_trace(registry);
}

TraceState state(const std::string & platform) {
  Registry registry(PlatformPaths::of(platform));
  return trace_state(registry);
}

class BoundSaver {
public:
  explicit BoundSaver(const std::string & platform) : registry_(PlatformPaths::of(platform)) {
    const nb::gil_scoped_release released;
    saver_ = std::make_unique<TraceSaver>(registry_);
  }
  const std::vector<ProcessTrace> & processes() const { return held().processes(); }
  uint64_t unplaced() const { return held().unplaced(); }
  void finish() { held().finish(); }
  void close() { saver_.reset(); }

private:
  TraceSaver & held() const {
    if (!saver_) {
      throw nb::value_error("the saver is closed");
    }
    return *saver_;
  }

  Registry registry_;
  std::unique_ptr<TraceSaver> saver_;
};

/// Traces actions of this process outside its nodes, under the same switch.
class OwnTracer {
public:
  explicit OwnTracer(const std::string & platform)
  : registry_(PlatformPaths::of(platform)), slot_(process_of(registry_, ProcessIdentity::own())) {
    const ProcessEntry & entry = registry_.processes()[slot_];
    registry_.tracer().follow(
      entry.trace, identity_of(registry_, slot_), registry_.clusters().at(entry.cluster).header());
  }
  bool is_on() { return registry_.tracer().is_on(); }
  void resume(uint32_t tid, uint64_t at_ns) {
    registry_.tracer().note_other(TraceKind::resume, tid, 0, at_ns, 0);
  }
  void align(uint64_t begin_ns, uint64_t end_ns) {
    registry_.tracer().note_other(TraceKind::align, nothing, 0, begin_ns, end_ns);
  }
  void pass(uint64_t begin_ns, uint64_t end_ns, uint32_t worker, uint16_t number) {
    registry_.tracer().note_other(TraceKind::pass, worker, number, begin_ns, end_ns);
  }

private:
  Registry registry_;
  uint32_t slot_;
};

nb::bytes events_of(const ThreadTrace & thread) {
  return nb::bytes(
    reinterpret_cast<const char *>(thread.events.data()),
    thread.events.size() * sizeof(TraceEvent));
}

template<size_t size>
auto text_at(char (TraceName::*field)[size]) {
  return [field](const TraceName & name) { return text(text_of(name.*field)); };
}

void bind_names(nb::module_ & module) {
  nb::class_<TraceName>(module, "TraceName")
    .def_ro("slot", &TraceName::slot)
    .def_ro("incarnation", &TraceName::incarnation)
    .def_ro("process", &TraceName::process)
    .def_ro("cluster", &TraceName::cluster)
    .def_prop_ro(
      "is_publisher",
      [](const TraceName & name) {
        return name.kind == static_cast<uint8_t>(EndpointKind::publisher);
      })
    .def_ro("role", &TraceName::role)
    .def_prop_ro("topic", text_at(&TraceName::topic))
    .def_prop_ro("type", text_at(&TraceName::type))
    .def_prop_ro("node", text_at(&TraceName::node));
}

void bind_recorded(nb::module_ & module) {
  nb::class_<ThreadTrace>(module, "ThreadTrace")
    .def_ro("tid", &ThreadTrace::tid)
    .def_prop_ro("name", name<ThreadTrace>(&ThreadTrace::name))
    .def_prop_ro("events", &events_of)
    .def_ro("lost", &ThreadTrace::lost);
  nb::class_<ProcessTrace>(module, "ProcessTrace")
    .def_ro("cluster", &ProcessTrace::cluster)
    .def_ro("process", &ProcessTrace::process)
    .def_ro("pid", &ProcessTrace::pid)
    .def_ro("core", &ProcessTrace::core)
    .def_ro("host_cpu", &ProcessTrace::host_cpu)
    .def_prop_ro("label", name<ProcessTrace>(&ProcessTrace::label))
    .def_ro("alive", &ProcessTrace::alive)
    .def_ro("threads", &ProcessTrace::threads)
    .def_ro("names", &ProcessTrace::names)
    .def_ro("unplaced", &ProcessTrace::unplaced);
}

}  // namespace

void bind_trace(nb::module_ & module) {
  bind_names(module);
  bind_recorded(module);
  nb::class_<TraceState>(module, "TraceState")
    .def_ro("started_ns", &TraceState::started_ns)
    .def_ro("clusters", &TraceState::clusters)
    .def_ro("nodes", &TraceState::nodes)
    .def_ro("ring_events", &TraceState::ring_events)
    .def_ro("pending", &TraceState::pending)
    .def_ro("lost", &TraceState::lost);
  module.def(
    "start_trace", &start, nb::arg("platform"), nb::kw_only(), nb::arg("clusters"),
    nb::arg("nodes"), nb::arg("events"), nb::arg("discard"));
  module.def("stop_trace", &stop, nb::arg("platform"));
  module.def("trace_state", &state, nb::arg("platform"));
  nb::class_<OwnTracer>(module, "OwnTracer")
    .def(nb::init<const std::string &>(), nb::arg("platform"))
    .def_prop_ro("is_on", &OwnTracer::is_on)
    .def("resume", &OwnTracer::resume, nb::arg("tid"), nb::arg("at_ns"))
    .def("align", &OwnTracer::align, nb::arg("begin_ns"), nb::arg("end_ns"))
    .def(
      "run_pass", &OwnTracer::pass, nb::arg("begin_ns"), nb::arg("end_ns"), nb::arg("worker"),
      nb::arg("number"));
  nb::class_<BoundSaver> bound(module, "TraceSaver");
  bound.def(nb::init<const std::string &>(), nb::arg("platform"))
    .def_prop_ro("processes", &BoundSaver::processes)
    .def_prop_ro("unplaced", &BoundSaver::unplaced)
    .def("finish", &BoundSaver::finish);
  bind_context(bound);
}

}  // namespace manycore::python
