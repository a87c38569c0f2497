// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Members of a platform without ROS: the inside of the bridge, and the tools.

#include "transport/process.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>

#include <cstring>

#include "platform/clock.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/dictionaries.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

Correlation correlation_from(const std::optional<nb::bytes> & client, int64_t number) {
  Correlation correlation;
  if (client) {
    if (client->size() != correlation.client.size()) {
      throw nb::value_error("client: expected the 16 bytes of a gid");
    }
    std::memcpy(correlation.client.data(), client->data(), client->size());
    correlation.number = number;
  }
  return correlation;
}

nb::bytes to_bytes(const Gid & gid) { return nb::bytes(gid.data(), gid.size()); }

/// A publisher and the membership it needs.
class BoundPublisher {
public:
  BoundPublisher(std::shared_ptr<Process> process, const EndpointSpec & spec)
  : process_(std::move(process)), publisher_(process_->create_publisher(spec)) {}

  uint64_t publish(
    const nb::bytes & data, std::optional<int64_t> source_timestamp_ns,
    const std::optional<nb::bytes> & client, int64_t number) {
    return send(data.c_str(), data.size(), source_timestamp_ns, correlation_from(client, number));
  }
  uint64_t publish_from(
    uintptr_t address, size_t size, std::optional<int64_t> source_timestamp_ns) {
    return send(reinterpret_cast<const void *>(address), size, source_timestamp_ns, {});
  }
  nb::bytes gid() const { return to_bytes(publisher_->gid()); }
  uint64_t matched() const { return publisher_->matched().current; }

private:
  uint64_t send(
    const void * bytes, size_t size, std::optional<int64_t> source_timestamp_ns,
    const Correlation & correlation) {
    const nb::gil_scoped_release released;
    Draft draft = publisher_->draft(size);
    std::memcpy(draft.data(), bytes, size);
    return publisher_->publish(
      std::move(draft), size, source_timestamp_ns.value_or(realtime_ns()), correlation);
  }

  std::shared_ptr<Process> process_;
  std::unique_ptr<Publisher> publisher_;
};

/// A record in its place in the topic DSM, until released.
class BoundClaim {
public:
  explicit BoundClaim(Claim && claim) : claim_(std::move(claim)) {}

  uintptr_t address() const { return reinterpret_cast<uintptr_t>(held().data()); }
  size_t size() const { return held().size(); }
  nb::bytes data() const { return nb::bytes(held().data(), held().size()); }
  nb::bytes publisher() const { return to_bytes(held().info().publisher); }
  nb::bytes client() const { return to_bytes(held().info().correlation.client); }
  int64_t number() const { return held().info().correlation.number; }
  int64_t source_timestamp_ns() const { return held().info().source_timestamp_ns; }
  uint64_t sequence() const { return held().info().publication_sequence_number; }
  void release() { claim_.reset(); }

private:
  const Claim & held() const {
    if (!claim_) {
      throw nb::value_error("the claim has been released");
    }
    return *claim_;
  }

  std::optional<Claim> claim_;
};

class BoundSubscription {
public:
  BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec)
  : process_(std::move(process)), subscription_(process_->create_subscription(spec)) {}

  std::unique_ptr<BoundClaim> claim() {
    std::optional<Claim> claim = subscription_->claim();
    return claim ? std::make_unique<BoundClaim>(std::move(*claim)) : nullptr;
  }
  std::optional<std::tuple<nb::bytes, nb::dict>> take() {
    const std::optional<Claim> claim = subscription_->claim();
    if (!claim) {
      return std::nullopt;
    }
    const RecordInfo & info = claim->info();
    nb::dict out;
    out["source_timestamp_ns"] = info.source_timestamp_ns;
    out["received_timestamp_ns"] = info.received_timestamp_ns;
    out["publication_sequence_number"] = info.publication_sequence_number;
    out["reception_sequence_number"] = info.reception_sequence_number;
    out["publisher"] = hex(info.publisher.data(), info.publisher.size());
    return std::make_tuple(nb::bytes(claim->data(), claim->size()), out);
  }
  nb::bytes gid() const { return to_bytes(subscription_->gid()); }
  uint64_t matched() const { return subscription_->matched().current; }
  uint64_t lost() const { return subscription_->lost(); }
  bool has_data() const { return subscription_->has_data(); }

private:
  std::shared_ptr<Process> process_;
  std::unique_ptr<Subscription> subscription_;
};

EndpointRole role_from(const std::string & role) {
  if (role == "topic") {
    return EndpointRole::topic;
  }
  if (role == "request") {
    return EndpointRole::request;
  }
  if (role == "reply") {
    return EndpointRole::reply;
  }
  throw nb::value_error(
    ("role: expected 'topic', 'request' or 'reply', found '" + role + "'").c_str());
}

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

  BoundPublisher * publisher(
    const std::string & topic, const std::string & type, const nb::dict & qos,
    const std::string & role, const std::string & type_hash) {
    return new BoundPublisher(process_, spec(topic, type, qos, role, type_hash));
  }
  BoundSubscription * subscription(
    const std::string & topic, const std::string & type, const nb::dict & qos,
    const std::string & role, const std::string & type_hash) {
    return new BoundSubscription(process_, spec(topic, type, qos, role, type_hash));
  }
  nb::list endpoints_of(const std::string & topic) const {
    const std::vector<NodeInfo> nodes = process_->graph().nodes();
    nb::list all;
    for (const EndpointInfo & endpoint : process_->graph().endpoints_of(topic)) {
      all.append(to_dict(endpoint, nodes));
    }
    return all;
  }
  uint64_t graph_generation() const { return process_->graph().generation(); }
  void watch_graph() { process_->waiter().watch_graph(); }
  uint32_t epoch() const { return process_->waiter().epoch(); }
  bool wait(uint32_t seen, std::optional<double> timeout_s) {
    std::optional<int64_t> deadline_ns;
    if (timeout_s) {
      deadline_ns = monotonic_ns() + static_cast<int64_t>(*timeout_s * ns_per_s);
    }
    const nb::gil_scoped_release released;
    return process_->waiter().wait(seen, deadline_ns);
  }
  void notify() { process_->waiter().notify(); }

private:
  EndpointSpec spec(
    const std::string & topic, const std::string & type, const nb::dict & qos,
    const std::string & role, const std::string & type_hash) const {
    EndpointSpec spec;
    spec.node = node_;
    spec.role = role_from(role);
    if (!type_hash.empty()) {
      spec.type_hash = type_hash_from(type_hash);
    }
    spec.topic = topic;
    spec.type = type;
    spec.qos = qos_from(qos);
    return spec;
  }

  std::shared_ptr<Process> process_;
  uint32_t node_ = 0;
};

}  // namespace

void bind_process(nb::module_ & module) {
  nb::class_<BoundPublisher>(module, "Publisher")
    .def(
      "publish", &BoundPublisher::publish, nb::arg("data"),
      nb::arg("source_timestamp_ns") = nb::none(), nb::arg("client") = nb::none(),
      nb::arg("number") = 0)
    .def(
      "publish_from", &BoundPublisher::publish_from, nb::arg("address"), nb::arg("size"),
      nb::arg("source_timestamp_ns") = nb::none())
    .def_prop_ro("gid", &BoundPublisher::gid)
    .def("matched", &BoundPublisher::matched);
  nb::class_<BoundClaim>(module, "Claim")
    .def_prop_ro("address", &BoundClaim::address)
    .def_prop_ro("size", &BoundClaim::size)
    .def_prop_ro("data", &BoundClaim::data)
    .def_prop_ro("publisher", &BoundClaim::publisher)
    .def_prop_ro("client", &BoundClaim::client)
    .def_prop_ro("number", &BoundClaim::number)
    .def_prop_ro("source_timestamp_ns", &BoundClaim::source_timestamp_ns)
    .def_prop_ro("sequence", &BoundClaim::sequence)
    .def("release", &BoundClaim::release);
  nb::class_<BoundSubscription>(module, "Subscription")
    .def("claim", &BoundSubscription::claim)
    .def("take", &BoundSubscription::take)
    .def_prop_ro("gid", &BoundSubscription::gid)
    .def("has_data", &BoundSubscription::has_data)
    .def("matched", &BoundSubscription::matched)
    .def("lost", &BoundSubscription::lost);
  nb::class_<BoundProcess>(module, "Process")
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
}

}  // namespace manycore::python
