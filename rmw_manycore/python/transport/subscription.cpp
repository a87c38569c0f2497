// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/subscription.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/unique_ptr.h>

#include "python/transport/bindings.hpp"
#include "python/transport/gid.hpp"
#include "transport/layout/chunk_layout.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

int get_buffer(PyObject * self, Py_buffer * view, int flags) noexcept {
  return nb::inst_ptr<BoundClaim>(self)->add_view(self, view, flags);
}

void release_buffer(PyObject * self, Py_buffer *) noexcept {
  nb::inst_ptr<BoundClaim>(self)->remove_view();
}

PyType_Slot claim_slots[] = {
  {Py_bf_getbuffer, reinterpret_cast<void *>(&get_buffer)},
  {Py_bf_releasebuffer, reinterpret_cast<void *>(&release_buffer)},
  {0, nullptr}};

}  // namespace

BoundClaim::BoundClaim(std::shared_ptr<SharedSubscription> source, Claim && claim)
: source_(std::move(source)), claim_(std::move(claim)), info_(claim_->info()) {
  source_->is_claimed = true;
}

nb::bytes BoundClaim::publisher() const { return to_bytes(info_.publisher); }

nb::bytes BoundClaim::client() const { return to_bytes(held().info().correlation.client); }

const Claim & BoundClaim::held() const {
  if (!claim_) {
    throw nb::value_error("the claim has been released");
  }
  return *claim_;
}

nb::object BoundClaim::array(nb::handle_t<BoundClaim> self) {
  const auto & claim = *nb::inst_ptr<BoundClaim>(self);
  if (claim.is_over_ || !claim.claim_) {
    raise_error(
      "TransportError",
      nb::str("the message was released: use its array inside `with`, or copy()"));
  }
  return claim.source_->arrays.value().array_in(self, claim.claim_->data(), claim.claim_->size());
}

void BoundClaim::release() {
  if (!try_release()) {
    raise_in_use("IN_USE");
  }
}

void BoundClaim::exit(nb::handle error, nb::handle, nb::handle) {
  if (!try_release() && error.is_none()) {
    raise_in_use("IN_USE");
  }
}

bool BoundClaim::try_release() noexcept {
  const bool was_over = std::exchange(is_over_, true);
  if (views_ == 0) {
    end();
  }
  return was_over || views_ == 0;
}

void BoundClaim::remove_view() noexcept {
  if (--views_ == 0 && is_over_) {
    end();
  }
}

int BoundClaim::add_view(PyObject * self, Py_buffer * view, int flags) noexcept {
  if (!claim_) {
    view->obj = nullptr;
    PyErr_SetString(PyExc_ValueError, "the claim has been released");
    return -1;
  }
  const auto size = static_cast<Py_ssize_t>(claim_->size());
  constexpr int is_read_only = 1;
  void * const data = const_cast<uint8_t *>(claim_->data());
  if (PyBuffer_FillInfo(view, self, data, size, is_read_only, flags) != 0) {
    return -1;
  }
  if (!is_counted_ && claim_->size() >= min_chunk_message_bytes) {
    claim_->count_in_place();
    is_counted_ = true;
  }
  ++views_;
  return 0;
}

void BoundClaim::end() noexcept {
  if (claim_) {
    claim_.reset();
    source_->is_claimed = false;
    source_.reset();
  }
}

BoundSubscription::BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec)
: shared_(std::make_shared<SharedSubscription>(std::move(process), spec)) {}

void BoundSubscription::read_arrays(nb::object dtype, nb::object layout_of) {
  held()->arrays.emplace(std::move(dtype), std::move(layout_of));
}

std::unique_ptr<BoundClaim> BoundSubscription::claim() {
  if (held()->is_claimed) {
    shared_->process->require_membership();
    throw nb::buffer_error("the record claimed before has not been released");
  }
  if (subscription().is_under_way()) {
    return nullptr;
  }
  std::optional<Claim> claim = subscription().claim();
  return claim ? std::make_unique<BoundClaim>(shared_, std::move(*claim)) : nullptr;
}

void BoundSubscription::note_bridged() {
  if (held()->process->tracer().is_on()) {
    const auto slot = static_cast<uint32_t>(endpoint_in(subscription().gid()));
    shared_->process->tracer().note(TraceKind::bridge_out, slot);
  }
}

const std::shared_ptr<SharedSubscription> & BoundSubscription::held() const {
  if (!shared_) {
    throw nb::value_error("the subscription is closed");
  }
  return shared_;
}

nb::bytes BoundSubscription::gid() const { return to_bytes(subscription().gid()); }

void bind_subscription(nb::module_ & module) {
  nb::class_<BoundClaim>(
    module, "Message", nb::type_slots(claim_slots), nb::is_generic(),
    "A message in shared memory, released at the end of its `with`.")
    .def_prop_ro("address", &BoundClaim::address)
    .def_prop_ro("size", &BoundClaim::size)
    .def_prop_ro("data", &BoundClaim::data)
    .def_prop_ro("publisher", &BoundClaim::publisher)
    .def_prop_ro("client", &BoundClaim::client)
    .def_prop_ro("number", &BoundClaim::number)
    .def_prop_ro("source_timestamp_ns", &BoundClaim::source_timestamp_ns)
    .def_prop_ro("sequence", &BoundClaim::sequence)
    .def_prop_ro("array", &BoundClaim::array)
    .def(
      "copy", [](nb::handle_t<BoundClaim> self) { return BoundClaim::array(self).attr("copy")(); })
    .def("release", &BoundClaim::release)
    .def("__enter__", [](nb::handle_t<BoundClaim> self) { return self; })
    .def("__exit__", &BoundClaim::exit, nb::arg().none(), nb::arg().none(), nb::arg().none());
  nb::class_<BoundSubscription>(module, "Subscription")
    .def("read_arrays", &BoundSubscription::read_arrays)
    .def("claim", &BoundSubscription::claim)
    .def("note_bridged", &BoundSubscription::note_bridged)
    .def_prop_ro("gid", &BoundSubscription::gid)
    .def("has_data", &BoundSubscription::has_data)
    .def("matched", &BoundSubscription::matched)
    .def("lost", &BoundSubscription::lost)
    .def("superseded", &BoundSubscription::superseded)
    .def("close", &BoundSubscription::close);
}

}  // namespace manycore::python
