// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/publisher.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "platform/clock.hpp"
#include "python/transport/arrays.hpp"
#include "python/transport/bindings.hpp"
#include "python/transport/gid.hpp"
#include "virtual_time/door.hpp"

namespace nb = nanobind;

namespace manycore::python {
namespace {

Correlation correlation_from(const std::optional<nb::bytes> & client, int64_t number) {
  Correlation correlation;
  if (client) {
    correlation.client = gid_from(*client, "client");
    correlation.number = number;
  }
  return correlation;
}

/// The bytes of an object with Python's buffer protocol, in one piece. To be made and unmade with
/// the GIL.
class BufferView {
public:
  explicit BufferView(const nb::object & object) {
    if (PyObject_GetBuffer(object.ptr(), &view_, PyBUF_SIMPLE) != 0) {
      throw nb::python_error();
    }
  }
  ~BufferView() { PyBuffer_Release(&view_); }
  BufferView(const BufferView &) = delete;
  BufferView & operator=(const BufferView &) = delete;

  std::string_view bytes() const {
    return {static_cast<const char *>(view_.buf), static_cast<size_t>(view_.len)};
  }

private:
  Py_buffer view_{};
};

int get_room(PyObject * self, Py_buffer * view, int flags) noexcept {
  return nb::inst_ptr<BoundLoan>(self)->add_view(self, view, flags);
}

void release_room(PyObject * self, Py_buffer *) noexcept {
  nb::inst_ptr<BoundLoan>(self)->remove_view();
}

PyType_Slot loan_slots[] = {
  {Py_bf_getbuffer, reinterpret_cast<void *>(&get_room)},
  {Py_bf_releasebuffer, reinterpret_cast<void *>(&release_room)},
  {0, nullptr}};

}  // namespace

BoundLoan::BoundLoan(
  std::shared_ptr<SharedPublisher> source, Loan && loan, const nb::bytes & head, size_t body_bytes,
  nb::object shape, nb::object dtype)
: source_(std::move(source)),
  loan_(std::move(loan)),
  head_bytes_(head.size()),
  body_bytes_(body_bytes),
  shape_(std::move(shape)),
  dtype_(std::move(dtype)) {
  std::memcpy(loan_->data(), head.c_str(), head.size());
}

nb::object BoundLoan::array(nb::handle_t<BoundLoan> self) {
  const auto & loan = *nb::inst_ptr<BoundLoan>(self);
  if (loan.is_over_) {
    raise_error("TransportError", nb::str("the loan is over: fill its array inside `with`"));
  }
  return array_over(self, loan.dtype_, loan.shape_, loan.body_bytes_ == 0 ? 0 : -1, 0);
}

void BoundLoan::exit(nb::handle error, nb::handle, nb::handle) {
  if (std::exchange(is_over_, true)) {
    return;
  }
  if (views_ == 0) {
    error.is_none() ? publish() : end();
  } else if (error.is_none()) {
    raise_in_use("LOAN_IN_USE");
  }
}

void BoundLoan::publish() {
  const std::shared_ptr<SharedPublisher> source = source_;
  Loan loan = std::move(*loan_);
  end();
  const nb::gil_scoped_release released;
  const int64_t now_ns = publish_now_ns(source->publisher->slot());
  sequence_ = source->publisher->publish(std::move(loan), head_bytes_ + body_bytes_, now_ns);
}

void BoundLoan::remove_view() noexcept {
  if (--views_ == 0 && is_over_) {
    end();
  }
}

int BoundLoan::add_view(PyObject * self, Py_buffer * view, int flags) noexcept {
  if (!loan_) {
    view->obj = nullptr;
    PyErr_SetString(PyExc_ValueError, "the loan is over");
    return -1;
  }
  constexpr int is_read_only = 0;
  uint8_t * const body = loan_->data() + head_bytes_;
  if (
    PyBuffer_FillInfo(
      view, self, body, static_cast<Py_ssize_t>(body_bytes_), is_read_only, flags) != 0) {
    return -1;
  }
  ++views_;
  return 0;
}

void BoundLoan::end() noexcept {
  loan_.reset();
  source_.reset();
}

BoundPublisher::BoundPublisher(std::shared_ptr<Process> process, const EndpointSpec & spec)
: shared_(std::make_shared<SharedPublisher>(std::move(process), spec)) {}

uint64_t BoundPublisher::publish(
  const nb::bytes & data, std::optional<int64_t> source_timestamp_ns,
  const std::optional<nb::bytes> & client, int64_t number) {
  const std::string_view bytes(data.c_str(), data.size());
  return send({bytes}, source_timestamp_ns, correlation_from(client, number));
}

uint64_t BoundPublisher::publish_from(
  uintptr_t address, size_t size, std::optional<int64_t> source_timestamp_ns) {
  Tracer & tracer = held()->process->tracer();
  if (source_timestamp_ns && tracer.is_on()) {
    const auto slot = held()->publisher->slot();
    const int64_t age_ns = std::max<int64_t>(realtime_ns() - *source_timestamp_ns, 0);
    tracer.note(TraceKind::bridge_in, slot, 0, static_cast<uint64_t>(age_ns));
  }
  return send({{reinterpret_cast<const char *>(address), size}}, source_timestamp_ns, {});
}

uint64_t BoundPublisher::publish_parts(const nb::bytes & head, const nb::object & body) {
  const BufferView view(body);
  return send({{head.c_str(), head.size()}, view.bytes()}, std::nullopt, {});
}

std::unique_ptr<BoundLoan> BoundPublisher::lend(
  const nb::bytes & head, size_t body_bytes, nb::object shape, nb::object dtype) {
  const std::shared_ptr<SharedPublisher> shared = held();
  const size_t size_bytes = head.size() + body_bytes;
  std::optional<Loan> loan = [&] {
    const nb::gil_scoped_release released;
    return shared->publisher->lend(size_bytes);
  }();
  if (!loan) {
    return nullptr;
  }
  return std::make_unique<BoundLoan>(
    shared, std::move(*loan), head, body_bytes, std::move(shape), std::move(dtype));
}

nb::bytes BoundPublisher::gid() const { return to_bytes(held()->publisher->gid()); }

const std::shared_ptr<SharedPublisher> & BoundPublisher::held() const {
  if (!shared_) {
    throw nb::value_error("the publisher is closed");
  }
  return shared_;
}

uint64_t BoundPublisher::send(
  std::initializer_list<std::string_view> parts, std::optional<int64_t> source_timestamp_ns,
  const Correlation & correlation) {
  const std::shared_ptr<SharedPublisher> shared = held();
  const nb::gil_scoped_release released;
  const int64_t now_ns = publish_now_ns(shared->publisher->slot());
  size_t size = 0;
  for (const std::string_view & part : parts) {
    size += part.size();
  }
  Draft draft = shared->publisher->draft(size);
  uint8_t * end = draft.data();
  for (const std::string_view & part : parts) {
    if (!part.empty()) {
      std::memcpy(end, part.data(), part.size());
      end += part.size();
    }
  }
  return shared->publisher->publish(
    std::move(draft), size, source_timestamp_ns.value_or(now_ns), correlation);
}

void bind_publisher(nb::module_ & module) {
  nb::class_<BoundLoan>(
    module, "Loan", nb::type_slots(loan_slots), nb::is_generic(),
    "A message in the making, in shared memory; published at the end of its `with`.")
    .def_prop_ro("sequence", &BoundLoan::sequence)
    .def_prop_ro("array", &BoundLoan::array)
    .def("__enter__", [](nb::handle_t<BoundLoan> self) { return self; })
    .def("__exit__", &BoundLoan::exit, nb::arg().none(), nb::arg().none(), nb::arg().none());
  nb::class_<BoundPublisher>(module, "Publisher")
    .def(
      "publish", &BoundPublisher::publish, nb::arg("data"),
      nb::arg("source_timestamp_ns") = nb::none(), nb::arg("client") = nb::none(),
      nb::arg("number") = 0)
    .def(
      "publish_from", &BoundPublisher::publish_from, nb::arg("address"), nb::arg("size"),
      nb::arg("source_timestamp_ns") = nb::none())
    .def("publish_parts", &BoundPublisher::publish_parts, nb::arg("head"), nb::arg("body"))
    .def(
      "lend", &BoundPublisher::lend, nb::arg("head"), nb::arg("body_bytes"), nb::arg("shape"),
      nb::arg("dtype"))
    .def_prop_ro("gid", &BoundPublisher::gid)
    .def("matched", &BoundPublisher::matched)
    .def("close", &BoundPublisher::close);
}

}  // namespace manycore::python
