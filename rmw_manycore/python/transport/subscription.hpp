// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <utility>

#include "transport/process.hpp"

namespace manycore::python {

/// A subscription and the membership it needs. Shared with its claim, which Python may keep longer.
struct SharedSubscription {
  SharedSubscription(std::shared_ptr<Process> process_, const EndpointSpec & spec)
  : process(std::move(process_)), subscription(process->create_subscription(spec)) {}

  std::shared_ptr<Process> process;
  std::unique_ptr<Subscription> subscription;
  bool is_claimed = false;  ///< guarded by the GIL
};

/// A record claimed in its topic DSM, until released. Supports the buffer protocol: memory that
/// Python objects still view stays claimed, whatever becomes of this object.
class BoundClaim {
public:
  BoundClaim(std::shared_ptr<SharedSubscription> source, Claim && claim);
  ~BoundClaim() { end(); }
  BoundClaim(const BoundClaim &) = delete;
  BoundClaim & operator=(const BoundClaim &) = delete;

  uintptr_t address() const { return reinterpret_cast<uintptr_t>(held().data()); }
  size_t size() const { return held().size(); }
  nanobind::bytes data() const { return nanobind::bytes(held().data(), held().size()); }
  nanobind::bytes publisher() const;
  nanobind::bytes client() const;
  int64_t number() const { return held().info().correlation.number; }
  int64_t source_timestamp_ns() const { return held().info().source_timestamp_ns; }
  uint64_t sequence() const { return held().info().publication_sequence_number; }
  /// BufferError while something views the record.
  void release();

  /// Of the buffer protocol: -1 with a Python error set, or 0.
  int add_view(PyObject * self, Py_buffer * view, int flags) noexcept;
  void remove_view() noexcept { --views_; }

private:
  const Claim & held() const;
  void end() noexcept;

  std::shared_ptr<SharedSubscription> source_;
  std::optional<Claim> claim_;
  size_t views_ = 0;
  bool is_counted_ = false;  ///< as read in place
};

/// A subscription as Python has it, until closed.
class BoundSubscription {
public:
  BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec);

  /// BufferError while the claim before is not released: it could wait for itself.
  std::unique_ptr<BoundClaim> claim();
  /// Traces that the claimed message was published outside.
  void note_bridged();
  nanobind::bytes gid() const;
  uint64_t matched() const { return subscription().matched().current; }
  /// The claim, if there is one, stays valid.
  void close() { shared_.reset(); }
  uint64_t lost() const { return subscription().lost(); }
  uint64_t superseded() const { return subscription().superseded(); }
  bool has_data() const { return subscription().has_data(); }

private:
  const std::shared_ptr<SharedSubscription> & held() const;
  Subscription & subscription() const { return *held()->subscription; }

  std::shared_ptr<SharedSubscription> shared_;
};

}  // namespace manycore::python
