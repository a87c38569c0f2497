// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Members of a platform without ROS: the inside of the bridge, and the tools.

#include "transport/process.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include <cstring>

#include "platform/clock.hpp"
#include "python/bindings.hpp"
#include "python/dictionaries.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

/// A publisher and the membership it needs.
class BoundPublisher {
public:
  BoundPublisher(std::shared_ptr<Process> process, const EndpointSpec & spec)
  : process_(std::move(process)), publisher_(process_->create_publisher(spec)) {}

  uint64_t publish(const nb::bytes & data) {
    const size_t size = data.size();
    const char * const bytes = data.c_str();
    const nb::gil_scoped_release released;
    Draft draft = publisher_->draft(size);
    std::memcpy(draft.data(), bytes, size);
    return publisher_->publish(std::move(draft), size, realtime_ns());
  }
  uint64_t matched() const { return publisher_->matched().current; }

private:
  std::shared_ptr<Process> process_;
  std::unique_ptr<Publisher> publisher_;
};

class BoundSubscription {
public:
  BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec)
  : process_(std::move(process)), subscription_(process_->create_subscription(spec)) {}

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
  uint64_t matched() const { return subscription_->matched().current; }
  uint64_t lost() const { return subscription_->lost(); }
  bool has_data() const { return subscription_->has_data(); }

private:
  std::shared_ptr<Process> process_;
  std::unique_ptr<Subscription> subscription_;
};

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
    const std::string & topic, const std::string & type, const nb::dict & qos) {
    return new BoundPublisher(process_, spec(topic, type, qos));
  }
  BoundSubscription * subscription(
    const std::string & topic, const std::string & type, const nb::dict & qos) {
    return new BoundSubscription(process_, spec(topic, type, qos));
  }
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
  EndpointSpec spec(const std::string & topic, const std::string & type, const nb::dict & qos) const {
    EndpointSpec spec;
    spec.node = node_;
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
    .def("publish", &BoundPublisher::publish, nb::arg("data"))
    .def("matched", &BoundPublisher::matched);
  nb::class_<BoundSubscription>(module, "Subscription")
    .def("take", &BoundSubscription::take)
    .def("has_data", &BoundSubscription::has_data)
    .def("matched", &BoundSubscription::matched)
    .def("lost", &BoundSubscription::lost);
  nb::class_<BoundProcess>(module, "Process")
    .def(nb::init<const std::string &, uint32_t, std::optional<uint32_t>, const std::string &>(),
         nb::arg("platform"), nb::arg("cluster") = 1, nb::arg("core") = nb::none(),
         nb::arg("label") = "tool")
    .def("publisher", &BoundProcess::publisher, nb::arg("topic"), nb::arg("type"), nb::arg("qos"))
    .def("subscription", &BoundProcess::subscription, nb::arg("topic"), nb::arg("type"),
         nb::arg("qos"))
    .def("epoch", &BoundProcess::epoch)
    .def("wait", &BoundProcess::wait, nb::arg("seen"), nb::arg("timeout_s") = nb::none())
    .def("notify", &BoundProcess::notify);
}

}  // namespace manycore::python
