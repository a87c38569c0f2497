// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "transport/queue/subscriber_queue.hpp"
#include "transport/subscription/backlog.hpp"
#include "transport/subscription/reception_counts.hpp"
#include "transport/subscription/source_list.hpp"

namespace manycore {

/// Finds the next record that a subscription has to read: in its queue, or by looking into its
/// sources. See docs/design/topic_dsm.md, Take and Resync. One thread at a time (the subscription's
/// mutex), but for has_some(), waiting() and has_to_resync().
class RecordFinder {
public:
  struct Candidate {
    Source * source;
    uint64_t number;
  };

  RecordFinder(
    Registry & registry, Cluster & cluster, SubscriptionHeader & header, EndpointEntry & entry,
    ReceptionCounts & counts) noexcept;

  /// It may turn out to be gone when it is claimed.
  std::optional<Candidate> next();
  void resync_if_asked();

  /// May be mistaken; never where a record waits that was announced.
  bool has_some() const noexcept;
  bool has_to_resync() const noexcept;
  /// Records in backlog and queue; some may be stale or doubles.
  uint64_t waiting() const noexcept;
  /// Notifications since creation, and records that a resync found without one.
  uint64_t arrivals() const noexcept;

private:
  std::optional<Candidate> next_of_backlog();
  /// True once for each time that `resync` was set; the caller then has to.
  bool take_request_to_resync() noexcept;
  /// The record that a hint of the queue names, or nothing when it is stale.
  std::optional<Candidate> candidate_of(const Hint & hint) noexcept;
  /// `popped`: a hint that its caller has not used.
  void resync(std::optional<Hint> popped = std::nullopt);
  void drain_queue(std::optional<Hint> popped);
  uint64_t count_announced(const std::vector<Source::Waiting> & found) const;
  void drop_beyond_depth();
  /// With nothing left to take: accounts for what was lost after the last message taken of each
  /// source.
  void settle() noexcept;

  Registry & registry_;
  SubscriptionHeader & header_;
  ReceptionCounts & counts_;
  SourceList sources_;
  Backlog backlog_;
  std::atomic<uint64_t> arrivals_by_resync_{0};  ///< those that no hint announced
  std::vector<Source::Waiting> found_;           ///< by a resync; a member to keep its memory
  std::vector<std::pair<uint32_t, uint64_t>> announced_;  ///< source and number of each hint
};

}  // namespace manycore
