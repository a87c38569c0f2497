// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/subscription.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/unique_ptr.h>

#include "python/transport/bindings.hpp"
#include "python/transport/gid.hpp"

namespace nb = nanobind;

namespace manycore::python {

nb::bytes BoundClaim::publisher() const { return to_bytes(held().info().publisher); }

nb::bytes BoundClaim::client() const { return to_bytes(held().info().correlation.client); }

const Claim & BoundClaim::held() const {
  if (!claim_) {
    throw nb::value_error("the claim has been released");
  }
  return *claim_;
}

BoundSubscription::BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec)
: process_(std::move(process)), subscription_(process_->create_subscription(spec)) {}

std::unique_ptr<BoundClaim> BoundSubscription::claim() {
  std::optional<Claim> claim = subscription_->claim();
  return claim ? std::make_unique<BoundClaim>(std::move(*claim)) : nullptr;
}

void BoundSubscription::note_bridged() {
  if (process_->tracer().is_on()) {
    const auto slot = static_cast<uint32_t>(endpoint_in(subscription_->gid()));
    process_->tracer().note(TraceKind::bridge_out, slot);
  }
}

nb::bytes BoundSubscription::gid() const { return to_bytes(subscription_->gid()); }

void bind_subscription(nb::module_ & module) {
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
    .def("note_bridged", &BoundSubscription::note_bridged)
    .def_prop_ro("gid", &BoundSubscription::gid)
    .def("has_data", &BoundSubscription::has_data)
    .def("matched", &BoundSubscription::matched)
    .def("lost", &BoundSubscription::lost);
}

}  // namespace manycore::python
