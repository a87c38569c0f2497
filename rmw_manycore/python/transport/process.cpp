// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Binding of a platform's member process without ROS, for the bridge and the tools.

#include "transport/process.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <utility>

#include "platform/error.hpp"
#include "platform/late_exit.hpp"
#include "python/context.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/gid.hpp"
#include "python/transport/publisher.hpp"
#include "python/transport/rows.hpp"
#include "python/transport/subscription.hpp"
#include "python/transport/type_hash.hpp"
#include "python/transport/words.hpp"
#include "virtual_time/door.hpp"
#include "virtual_time/seats.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

/// How long a spinning wait may leave signals unnoticed; sleeping ones notice them at once.
constexpr int64_t max_spin_ns = 10'000'000;

std::optional<int64_t> end_of_turn(
  const Process & process, const std::optional<int64_t> & deadline_ns) {
  if (process.placement().wait_mode != WaitMode::spin) {
    return deadline_ns;
  }
  const int64_t turn_ns = qos_now_ns() + max_spin_ns;
  return deadline_ns ? std::min(*deadline_ns, turn_ns) : turn_ns;
}

/// Sleeps without the GIL until the epoch is another than `seen`; false at the deadline. Ends with
/// what a signal handler of Python raises, as KeyboardInterrupt.
bool sleep(Process & process, uint32_t seen, const std::optional<int64_t> & deadline_ns) {
  while (true) {
    {
      const nb::gil_scoped_release released;
      const auto turn_ns = end_of_turn(process, deadline_ns);
      if (process.waiters().common().wait(seen, turn_ns, OnSignal::give_up)) {
        return true;
      }
    }
    if (PyErr_CheckSignals() != 0) {
      throw nb::python_error();
    }
    if (deadline_ns && qos_now_ns() >= *deadline_ns) {
      return false;
    }
  }
}

/// A process has one place on a platform: whatever joins it again has to name the same one.
void check_joined_there(const Process & process, const Placement & asked) {
  const Placement & placement = process.placement();
  if (placement.cluster == asked.cluster && (!asked.core || placement.core == asked.core)) {
    return;
  }
  const std::string core = placement.core ? ", core " + std::to_string(*placement.core) : "";
  throw Error(
    ErrorCode::invalid_argument, "this process has joined platform '" + placement.platform +
                                   "' in cluster " + std::to_string(placement.cluster) + core +
                                   " already: join it there, or from another process");
}

/// A further node of the process, until it is destroyed.
class BoundNode {
public:
  BoundNode(std::shared_ptr<Process> process, const std::string & name, const std::string & ns)
  : process_(std::move(process)), handle_(process_->add_node(name, ns, "/")) {}
  ~BoundNode() { process_->remove_node(handle_); }
  BoundNode(const BoundNode &) = delete;
  BoundNode & operator=(const BoundNode &) = delete;

  uint32_t handle() const noexcept { return handle_; }

private:
  std::shared_ptr<Process> process_;
  uint32_t handle_;
};

/// A member process with one node, named by its label.
class BoundProcess {
public:
  BoundProcess(
    const std::string & platform, uint32_t cluster, std::optional<uint32_t> core,
    const std::string & label, const std::string & wait) {
    Placement placement;
    placement.platform = platform;
    placement.cluster = cluster;
    placement.core = core;
    placement.label = label;
    placement.wait_mode = from_word<WaitMode>(wait);
    process_ = Process::join(placement);
    check_joined_there(*process_, placement);
    node_ = process_->add_node(label, "/", "/");
  }

  std::unique_ptr<BoundNode> node(const std::string & name, const std::string & ns) const {
    return std::make_unique<BoundNode>(member(), name, ns);
  }
  std::unique_ptr<BoundPublisher> publisher(
    const std::string & topic, const std::string & type, const Qos & qos, const std::string & role,
    const std::string & type_hash, const BoundNode * node,
    const std::optional<nb::bytes> & gid) const {
    EndpointSpec asked = spec(topic, type, qos, role, type_hash);
    if (node != nullptr) {
      asked.node = node->handle();
    }
    if (gid) {
      asked.gid = gid_from(*gid, "gid");
    }
    return std::make_unique<BoundPublisher>(member(), asked);
  }
  std::unique_ptr<BoundSubscription> subscription(
    const std::string & topic, const std::string & type, const Qos & qos, const std::string & role,
    const std::string & type_hash) const {
    return std::make_unique<BoundSubscription>(member(), spec(topic, type, qos, role, type_hash));
  }
  std::vector<NodeInfo> nodes() const { return member()->graph().nodes(); }
  std::vector<EndpointRow> endpoints() const {
    const Graph & graph = member()->graph();
    return rows_of(graph, graph.endpoints(), HeldMemory::skipped);
  }
  std::vector<EndpointRow> endpoints_of(const std::string & topic) const {
    const Graph & graph = member()->graph();
    return rows_of(graph, graph.endpoints_of(topic), HeldMemory::skipped);
  }
  uint64_t graph_generation() const { return member()->graph().generation(); }
  void watch_graph() { member()->waiters().watch_graph(common_word); }
  uint32_t epoch() const { return member()->waiters().common().epoch(); }
  bool wait(uint32_t seen, std::optional<double> timeout_s) {
    // Keeps it alive: another thread may close this object.
    const std::shared_ptr<Process> process = member();
    process->tracer().note(TraceKind::wait_begin, nothing, 0, UINT64_MAX);
    virtual_time::end_turn(timeout_s && *timeout_s <= 0, [&] { return epoch() != seen; });
    std::optional<int64_t> deadline_ns;
    if (timeout_s) {
      deadline_ns = qos_now_ns() + static_cast<int64_t>(*timeout_s * ns_per_s);
    }
    const bool woken = sleep(*process, seen, deadline_ns);
    virtual_time::elapse(virtual_time::Step::woken);
    process->tracer().note(TraceKind::wait_end, nothing, 0, woken ? 1 : 0);
    return woken;
  }
  void require_membership() const { member()->require_membership(); }
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
  module.def("now_ns", &qos_now_ns);
  module.def(
    "exit_after",
    [](double delay_s, int status) {
      exit_after(std::chrono::nanoseconds(static_cast<int64_t>(delay_s * ns_per_s)), status);
    },
    nb::arg("delay_s"), nb::arg("status"));
  module.attr("virtual_now_offset") = offsetof(virtual_time::Page, now_ns);
  module.attr("virtual_start_ns") = virtual_time::start_ns;
  const nb::class_<BoundNode> node(module, "Node", nb::is_weak_referenceable());
  nb::class_<BoundProcess> bound(module, "Process");
  bound
    .def(
      nb::init<
        const std::string &, uint32_t, std::optional<uint32_t>, const std::string &,
        const std::string &>(),
      nb::arg("platform"), nb::arg("cluster") = 1, nb::arg("core") = nb::none(),
      nb::arg("label") = "tool", nb::arg("wait") = word_of(WaitMode::block))
    .def(
      "publisher", &BoundProcess::publisher, nb::arg("topic"), nb::arg("type"), nb::arg("qos"),
      nb::arg("role") = "topic", nb::arg("type_hash") = "", nb::arg("node") = nb::none(),
      nb::arg("gid") = nb::none(), nb::keep_alive<0, 7>())
    .def("node", &BoundProcess::node, nb::arg("name"), nb::arg("namespace"))
    .def("nodes", &BoundProcess::nodes)
    .def(
      "subscription", &BoundProcess::subscription, nb::arg("topic"), nb::arg("type"),
      nb::arg("qos"), nb::arg("role") = "topic", nb::arg("type_hash") = "")
    .def("endpoints", &BoundProcess::endpoints)
    .def("endpoints_of", &BoundProcess::endpoints_of, nb::arg("topic"))
    .def("graph_generation", &BoundProcess::graph_generation)
    .def("watch_graph", &BoundProcess::watch_graph)
    .def("epoch", &BoundProcess::epoch)
    .def("wait", &BoundProcess::wait, nb::arg("seen"), nb::arg("timeout_s") = nb::none())
    .def("require_membership", &BoundProcess::require_membership)
    .def("notify", &BoundProcess::notify);
  bind_context(bound);
}

}  // namespace manycore::python
