// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "transport/layout/endpoint.hpp"
#include "transport/layout/transfer_layout.hpp"
#include "transport/layout/wake_words.hpp"
#include "transport/subscription/claim.hpp"

namespace manycore {

/// Reading side: one subscriber queue (capacity = depth) over any number of topic DSMs.
/// Thread-safe.
class Subscription {
public:
  struct Impl;
  explicit Subscription(std::unique_ptr<Impl> impl);
  ~Subscription();

  const Gid & gid() const noexcept;
  const Qos & qos() const noexcept;
  Transfer transfer() const noexcept;
  const char * topic() const noexcept;
  const char * type() const noexcept;

  /// True if claim() may find a record. It may still find none: the record may be expired or
  /// overwritten.
  bool has_data() const noexcept;
  /// True if all records that claim() would find are under way on the platform that a run in
  /// virtual time models. It would wait for the first one.
  bool is_under_way() const noexcept;

  /// Threads that arrivals wake; initially the process's common word.
  Watchers & watchers() noexcept;

  /// Step 3 of ROS-lite2 Fig. 4: pops the queue and claims the record in its topic DSM.
  std::optional<Claim> claim();

  /// Notifications since creation (for on_new_message callbacks). Waits while a claim is held if
  /// has_to_resync().
  uint64_t arrivals() const noexcept;
  /// Those that are known without a resync; never waits.
  uint64_t announced() const noexcept;
  /// True if all publishers have to be looked at, for want of a notification of each message.
  bool has_to_resync() const noexcept;

  /// Notifications not claimed yet; some may be stale or duplicates.
  uint64_t waiting() const noexcept;

  /// Messages published for this subscription and overwritten before they were taken, or rejected,
  /// as far as known: the losses of a publisher are counted at the latest when a later message of
  /// it is taken.
  uint64_t lost() const noexcept;
  /// Messages not taken by a subscription that keeps the newest one only, and in whose place it
  /// found a newer one of their publisher. They are not lost.
  uint64_t superseded() const noexcept;

  MatchedCount matched() const;
  IncompatibleCount incompatible() const;
  uint64_t incompatible_types() const noexcept;
  TimedCount deadline_missed() const noexcept;
  LivelinessCount liveliness() const;

private:
  friend class Claim;
  std::unique_ptr<Impl> impl_;
};

}  // namespace manycore
