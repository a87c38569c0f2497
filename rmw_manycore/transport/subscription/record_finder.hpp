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

/// Finds the next record that a subscription has to read, in its queue or by scanning its sources.
/// See docs/design/topic_dsm.md, Take and Resync. Used by one thread at a time (the subscription's
/// mutex), except has_records(), waiting() and has_to_resync().
class RecordFinder {
public:
  struct Candidate {
    Source * source;
    Source::Wanted wanted;
  };

  RecordFinder(
    Registry & registry, Cluster & cluster, SubscriptionHeader & header, EndpointEntry & entry,
    ReceptionCounts & counts) noexcept;

  /// Next record to claim. The claim may find that it is gone. Throws std::bad_alloc, and costs no
  /// record then; so does resync_if_asked().
  std::optional<Candidate> next();
  void resync_if_asked();
  /// Accounts for messages lost after the last one taken from each source. Called when there is
  /// nothing left to take.
  void settle() noexcept;

  /// May be true without a record; never false while an announced record waits.
  bool has_records() const noexcept;
  bool has_to_resync() const noexcept;
  /// Records in backlog and queue; some may be stale or duplicates.
  uint64_t waiting() const noexcept;
  /// Hints pushed since creation, and records that a resync found without a hint.
  uint64_t arrivals() const noexcept;

private:
  template<typename Act>
  auto resync_later_if_it_lacks_memory(const Act & act);
  std::optional<Candidate> find_next();
  std::optional<Candidate> next_of_backlog();
  /// Resets `resync`. True if it was set: the caller must then call resync().
  bool take_request_to_resync() noexcept;
  /// `popped` is a hint taken from the queue and not used yet.
  void resync(std::optional<Hint> popped = std::nullopt);
  void drain_queue(std::optional<Hint> popped);
  uint64_t count_announced(const std::vector<Source::Waiting> & found) const;
  bool drop_beyond_depth();
  Registry & registry_;
  const Cluster & cluster_;
  SubscriptionHeader & header_;
  ReceptionCounts & counts_;
  SourceList sources_;
  Backlog backlog_;
  std::atomic<uint64_t> arrivals_by_resync_{0};  ///< records found without a hint
  std::vector<Source::Waiting> found_;           ///< by a resync, and not in the backlog yet
  std::vector<uint64_t> announced_;              ///< words of the drained hints
};

}  // namespace manycore
