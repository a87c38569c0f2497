// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <initializer_list>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "transport/process.hpp"

namespace manycore::python {

/// A publisher, and the membership that it requires. Shared with publishes that go on while another
/// thread closes.
struct SharedPublisher {
  SharedPublisher(std::shared_ptr<Process> process_, const EndpointSpec & spec)
  : process(std::move(process_)), publisher(process->create_publisher(spec)) {}

  std::shared_ptr<Process> process;
  std::unique_ptr<Publisher> publisher;
};

/// Room lent by a publisher, until it is published or given back. Supports the buffer protocol, as
/// writable memory behind `head`, the bytes before it.
class BoundLoan {
public:
  BoundLoan(
    std::shared_ptr<SharedPublisher> source, Loan && loan, const nanobind::bytes & head,
    size_t body_bytes, nanobind::object shape, nanobind::object dtype);
  ~BoundLoan() { end(); }
  BoundLoan(const BoundLoan &) = delete;
  BoundLoan & operator=(const BoundLoan &) = delete;

  /// Of the message once it is published.
  std::optional<uint64_t> sequence() const { return sequence_; }
  /// The array in the room. TransportError when the loan is over.
  static nanobind::object array(nanobind::handle_t<BoundLoan> self);
  /// The end of a `with`: publishes, or gives the room back after an error. MessageInUseError while
  /// something views the room, which is then given back with the last view.
  void exit(nanobind::handle error, nanobind::handle, nanobind::handle);

  /// Of the buffer protocol: -1 with a Python error set, or 0.
  int add_view(PyObject * self, Py_buffer * view, int flags) noexcept;
  void remove_view() noexcept;

private:
  void publish();
  void end() noexcept;

  std::shared_ptr<SharedPublisher> source_;
  std::optional<Loan> loan_;
  size_t head_bytes_;
  size_t body_bytes_;
  nanobind::object shape_;
  nanobind::object dtype_;
  std::optional<uint64_t> sequence_;
  size_t views_ = 0;
  bool is_over_ = false;
};

/// A publisher as Python has it, until closed.
class BoundPublisher {
public:
  BoundPublisher(std::shared_ptr<Process> process, const EndpointSpec & spec);

  uint64_t publish(
    const nanobind::bytes & data, std::optional<int64_t> source_timestamp_ns,
    const std::optional<nanobind::bytes> & client, int64_t number);
  uint64_t publish_from(uintptr_t address, size_t size, std::optional<int64_t> source_timestamp_ns);
  uint64_t publish_parts(const nanobind::bytes & head, const nanobind::object & body);
  /// None where the topic's records lie in its ring.
  std::unique_ptr<BoundLoan> lend(
    const nanobind::bytes & head, size_t body_bytes, nanobind::object shape,
    nanobind::object dtype);
  nanobind::bytes gid() const;
  uint64_t matched() const { return held()->publisher->matched().current; }
  void close() { shared_.reset(); }

private:
  uint64_t send(
    std::initializer_list<std::string_view> parts, std::optional<int64_t> source_timestamp_ns,
    const Correlation & correlation);

  const std::shared_ptr<SharedPublisher> & held() const;

  std::shared_ptr<SharedPublisher> shared_;
};

}  // namespace manycore::python
