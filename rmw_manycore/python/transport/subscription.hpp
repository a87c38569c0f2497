// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <utility>

#include "python/transport/arrays.hpp"
#include "transport/process.hpp"

namespace manycore::python {

/// A subscription and the membership it needs. Shared with its claim, which Python may keep longer.
struct SharedSubscription {
  SharedSubscription(std::shared_ptr<Process> process_, const EndpointSpec & spec)
  : process(std::move(process_)), subscription(process->create_subscription(spec)) {}

  std::shared_ptr<Process> process;
  std::unique_ptr<Subscription> subscription;
  std::optional<ArrayReader> arrays;  ///< of messages that are arrays
  bool is_claimed = false;            ///< guarded by the GIL
};

/// A record claimed in its topic DSM, until released. Supports the buffer protocol: memory that
/// Python objects still view stays claimed, until the last of them goes.
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
  // Also after release():
  int64_t source_timestamp_ns() const { return info_.source_timestamp_ns; }
  uint64_t sequence() const { return info_.publication_sequence_number; }

  /// The array that the message is, in its place. TransportError if it is none, or was released.
  static nanobind::object array(nanobind::handle_t<BoundClaim> self);
  /// MessageInUseError while something views the record.
  void release();
  /// The end of a `with`: an error in it may refer to arrays.
  void exit(nanobind::handle error, nanobind::handle, nanobind::handle);

  /// Of the buffer protocol: -1 with a Python error set, or 0.
  int add_view(PyObject * self, Py_buffer * view, int flags) noexcept;
  void remove_view() noexcept;

private:
  const Claim & held() const;
  /// False while something views the record: then with the last view.
  bool try_release() noexcept;
  void end() noexcept;

  std::shared_ptr<SharedSubscription> source_;
  std::optional<Claim> claim_;
  const RecordInfo info_;
  size_t views_ = 0;
  bool is_over_ = false;
  bool is_counted_ = false;  ///< as read in place
};

/// A subscription as Python has it, until closed.
class BoundSubscription {
public:
  BoundSubscription(std::shared_ptr<Process> process, const EndpointSpec & spec);

  /// Its messages are arrays, see ArrayReader.
  void read_arrays(nanobind::object dtype, nanobind::object layout_of);
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
