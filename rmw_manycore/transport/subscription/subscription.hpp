// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "transport/layout/endpoint.hpp"
#include "transport/layout/wake_words.hpp"
#include "transport/subscription/claim.hpp"

namespace manycore {

/// The reading role: one subscriber queue (capacity = depth) over any number of topic DSMs.
/// Thread-safe.
class Subscription {
public:
  struct Impl;
  explicit Subscription(std::unique_ptr<Impl> impl);
  ~Subscription();

  const Gid & gid() const noexcept;
  const Qos & qos() const noexcept;
  const char * topic() const noexcept;
  const char * type() const noexcept;

  /// True when claim() is worth calling (it may still find nothing: expired or overwritten).
  bool has_data() const noexcept;

  /// Those that arrivals wake. At first the process's common word.
  Watchers & watchers() noexcept;

  /// Step 3 of Fig. 4: pops the queue and claims the record in its topic DSM.
  std::optional<Claim> claim();

  /// Notifications received since creation (for on_new_message callbacks).
  uint64_t arrivals() const noexcept;

  /// Notifications that wait to be claimed; some may be stale or doubles.
  uint64_t waiting() const noexcept;

  /// Messages that were published for this subscription and are gone (overwritten before taken) or
  /// were rejected, as far as known: those of a publisher are counted by the time a later one of
  /// its messages is taken.
  uint64_t lost() const noexcept;

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
