// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <mutex>
#include <vector>

#include "transport/queue/subscriber_queue.hpp"
#include "transport/registry/membership.hpp"
#include "transport/subscription.hpp"
#include "transport/topic_dsm/topic_dsm_reader.hpp"

namespace manycore {

struct Subscription::Impl {
  Impl(Registry & registry_, uint32_t slot_);

  /// Allocates header and queue; the caller holds the registry lock.
  static SubscriptionHeader & create(Registry & registry, uint32_t endpoint_slot);

  struct Candidate {
    TopicDsmReader * reader;
    uint64_t number;
  };
  /// Next record to claim: from the backlog, else from the queue. The caller holds the mutex.
  std::optional<Candidate> next();
  std::optional<Candidate> next_of_backlog();
  /// The record that a hint of the queue names, or nothing when it is stale.
  std::optional<Candidate> candidate_of(const Hint & hint);
  /// The reader of a source, or nullptr when the source is gone.
  TopicDsmReader * find_reader(uint32_t source, uint32_t incarnation);
  void resync_if_asked();
  /// Follows the source table; true when it has a source that was not known yet.
  bool renew_readers();
  /// `popped`: a hint that its caller has not used.
  void resync(std::optional<Hint> popped = std::nullopt);
  /// With nothing left to take: accounts for what was lost after the last message taken of each
  /// source.
  void settle() noexcept;
  /// The displaced ones aside, which pushers count. The publisher numbers its replies to all
  /// clients together, so this subscription counts its own one by one as it misses them.
  void count_lost_replies(uint64_t count) noexcept;
  void count_taken(uint64_t bytes) noexcept;
  /// What was counted as taken was no message.
  void count_rejected(uint64_t bytes) noexcept;
  void count_lost(uint64_t count) noexcept;
  /// A finished topic DSM waits for its last reader only: frees it.
  void sweep() noexcept;

  Registry & registry;
  uint32_t slot;
  EndpointEntry & entry;
  Membership membership;
  Cluster & cluster;
  SubscriptionHeader & header;
  std::mutex mutex;  ///< held while a claim lives

  std::vector<TopicDsmReader> readers;
  uint64_t seen_source_generation = 0;
  std::deque<TopicDsmReader::Waiting> backlog;  ///< found by a resync, served before the queue
  std::atomic<size_t> backlog_size{0};          ///< for has_data() without the mutex
  std::atomic<uint64_t> arrivals_by_resync{0};  ///< those that no hint announced
  std::vector<TopicDsmReader::Waiting> scratch;
  std::vector<std::pair<uint32_t, uint64_t>>
    announced;  ///< of a resync: source and number of each hint
  uint64_t received = 0;
  bool unsettled = false;        ///< messages may be missing that no later one has shown to be
  uint64_t settled_dropped = 0;  ///< of the header's `dropped`, when everything was accounted for
  std::atomic<uint64_t> reported_lost{0};
};

}  // namespace manycore
