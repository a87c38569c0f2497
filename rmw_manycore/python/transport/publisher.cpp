// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/publisher.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "platform/clock.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/gid.hpp"

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

}  // namespace

BoundPublisher::BoundPublisher(std::shared_ptr<Process> process, const EndpointSpec & spec)
: process_(std::move(process)), publisher_(process_->create_publisher(spec)) {}

uint64_t BoundPublisher::publish(
  const nb::bytes & data, std::optional<int64_t> source_timestamp_ns,
  const std::optional<nb::bytes> & client, int64_t number) {
  return send(data.c_str(), data.size(), source_timestamp_ns, correlation_from(client, number));
}

uint64_t BoundPublisher::publish_from(
  uintptr_t address, size_t size, std::optional<int64_t> source_timestamp_ns) {
  if (source_timestamp_ns && process_->tracer().is_on()) {
    const auto slot = static_cast<uint32_t>(endpoint_in(publisher_->gid()));
    const int64_t age_ns = std::max<int64_t>(realtime_ns() - *source_timestamp_ns, 0);
    process_->tracer().note(TraceKind::bridge_in, slot, 0, static_cast<uint64_t>(age_ns));
  }
  return send(reinterpret_cast<const void *>(address), size, source_timestamp_ns, {});
}

nb::bytes BoundPublisher::gid() const { return to_bytes(publisher_->gid()); }

uint64_t BoundPublisher::send(
  const void * bytes, size_t size, std::optional<int64_t> source_timestamp_ns,
  const Correlation & correlation) {
  const nb::gil_scoped_release released;
  Draft draft = publisher_->draft(size);
  std::memcpy(draft.data(), bytes, size);
  return publisher_->publish(
    std::move(draft), size, source_timestamp_ns.value_or(realtime_ns()), correlation);
}

void bind_publisher(nb::module_ & module) {
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
}

}  // namespace manycore::python
