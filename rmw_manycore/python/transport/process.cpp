// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Members of a platform without ROS: the inside of the bridge, and the tools.

#include "transport/process.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "platform/clock.hpp"
#include "python/context.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/publisher.hpp"
#include "python/transport/rows.hpp"
#include "python/transport/subscription.hpp"
#include "python/transport/type_hash.hpp"
#include "python/transport/words.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

/// A member process with one node, named after its label.
class BoundProcess {
public:
  BoundProcess(
    const std::string & platform, uint32_t cluster, std::optional<uint32_t> core,
    const std::string & label) {
    Placement placement;
    placement.platform = platform;
    placement.cluster = cluster;
    placement.core = core;
    placement.label = label;
    process_ = Process::join(placement);
    node_ = process_->add_node(label, "/", "/");
  }

  std::unique_ptr<BoundPublisher> publisher(
    const std::string & topic, const std::string & type, const Qos & qos, const std::string & role,
    const std::string & type_hash) const {
    return std::make_unique<BoundPublisher>(member(), spec(topic, type, qos, role, type_hash));
  }
  std::unique_ptr<BoundSubscription> subscription(
    const std::string & topic, const std::string & type, const Qos & qos, const std::string & role,
    const std::string & type_hash) const {
    return std::make_unique<BoundSubscription>(member(), spec(topic, type, qos, role, type_hash));
  }
  std::vector<EndpointRow> endpoints_of(const std::string & topic) const {
    const std::vector<NodeInfo> nodes = member()->graph().nodes();
    return with_node_names(member()->graph().endpoints_of(topic), nodes);
  }
  uint64_t graph_generation() const { return member()->graph().generation(); }
  void watch_graph() { member()->waiters().graph_watchers().add(common_word); }
  uint32_t epoch() const { return member()->waiters().common().epoch(); }
  bool wait(uint32_t seen, std::optional<double> timeout_s) {
    std::optional<int64_t> deadline_ns;
    if (timeout_s) {
      deadline_ns = monotonic_ns() + static_cast<int64_t>(*timeout_s * ns_per_s);
    }
    const std::shared_ptr<Process> process = member();  // another thread may close this object
    const nb::gil_scoped_release released;
    process->tracer().note(TraceKind::wait_begin, nothing, 0, UINT64_MAX);
    const bool woken = process->waiters().common().wait(seen, deadline_ns);
    process->tracer().note(TraceKind::wait_end, nothing, 0, woken ? 1 : 0);
    return woken;
  }
  void notify() { member()->waiters().common().notify(); }
  void close() { process_.reset(); }

private:
  const std::shared_ptr<Process> & member() const {
    if (!process_) {
      throw nb::value_error("the process is closed");
    }
    return process_;
  }

  EndpointSpec spec(
    const std::string & topic, const std::string & type, const Qos & qos, const std::string & role,
    const std::string & type_hash) const {
    EndpointSpec spec;
    spec.node = node_;
    spec.role = from_word<EndpointRole>(role);
    if (!type_hash.empty()) {
      spec.type_hash = type_hash_from(type_hash);
    }
    spec.topic = topic;
    spec.type = type;
    spec.qos = qos;
    return spec;
  }

  std::shared_ptr<Process> process_;
  uint32_t node_ = 0;
};

}  // namespace

void bind_process(nb::module_ & module) {
  nb::class_<BoundProcess> bound(module, "Process");
  bound
    .def(
      nb::init<const std::string &, uint32_t, std::optional<uint32_t>, const std::string &>(),
      nb::arg("platform"), nb::arg("cluster") = 1, nb::arg("core") = nb::none(),
      nb::arg("label") = "tool")
    .def(
      "publisher", &BoundProcess::publisher, nb::arg("topic"), nb::arg("type"), nb::arg("qos"),
      nb::arg("role") = "topic", nb::arg("type_hash") = "")
    .def(
      "subscription", &BoundProcess::subscription, nb::arg("topic"), nb::arg("type"),
      nb::arg("qos"), nb::arg("role") = "topic", nb::arg("type_hash") = "")
    .def("endpoints_of", &BoundProcess::endpoints_of, nb::arg("topic"))
    .def("graph_generation", &BoundProcess::graph_generation)
    .def("watch_graph", &BoundProcess::watch_graph)
    .def("epoch", &BoundProcess::epoch)
    .def("wait", &BoundProcess::wait, nb::arg("seen"), nb::arg("timeout_s") = nb::none())
    .def("notify", &BoundProcess::notify);
  bind_context(bound);
}

}  // namespace manycore::python
