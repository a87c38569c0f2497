// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "transport/layout/endpoint.hpp"
#include "transport/layout/transfer_layout.hpp"
#include "transport/layout/wake_words.hpp"
#include "transport/publisher/draft.hpp"
#include "transport/publisher/loan.hpp"

namespace manycore {

/// Writing side of one topic DSM. Thread-safe. After destruction, messages stay until each reader
/// has taken them.
class Publisher {
public:
  struct Impl;
  explicit Publisher(std::unique_ptr<Impl> impl);
  ~Publisher();

  const Gid & gid() const noexcept;
  /// Of its row in the registry.
  uint32_t slot() const noexcept;
  const Qos & qos() const noexcept;
  Transfer transfer() const noexcept;

  /// Step 1 of ROS-lite2 Fig. 4, first half: room for `size_bytes` in the topic DSM to serialize
  /// into. Throws Error{too_large} (the text names the size needed), Error{no_space}, or
  /// Error{timeout} if RELIABLE + KEEP_ALL readers left no room within `max_blocking_ns`.
  Draft draft(size_t size_bytes);

  /// Step 1, second half: publishes the first `size_bytes` of the draft as a record and notifies
  /// readers. `source_timestamp_ns` is CLOCK_REALTIME. Returns the publication sequence number,
  /// which starts at 1. In role reply, only the client named in `correlation` receives the message.
  /// The caller does what threads that sleep on the words `spared` of this process would do about
  /// the arrival, also if this throws.
  uint64_t publish(
    Draft && draft, size_t size_bytes, int64_t source_timestamp_ns,
    const Correlation & correlation = {}, const WakeSet & spared = {});

  /// Room in shared memory that the caller fills before it is published, at leisure: other
  /// publishes go on. Nothing where the topic's records lie in the ring: draft() then. Throws as
  /// draft() does.
  std::optional<Loan> lend(size_t size_bytes);
  /// Publishes the first `size_bytes` of a loan; otherwise as above. If it throws, the loan is
  /// over.
  uint64_t publish(Loan && loan, size_t size_bytes, int64_t source_timestamp_ns);

  /// Renews the lease of MANUAL_BY_TOPIC liveliness, as publish() does. No effect on other kinds.
  void assert_liveliness();

  MatchedCount matched() const;
  IncompatibleCount incompatible() const;
  uint64_t incompatible_types() const noexcept;
  TimedCount deadline_missed() const noexcept;
  TimedCount liveliness_lost() const noexcept;

private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace manycore
