// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/matching/turn.hpp"
#include "transport/registry/registry.hpp"

namespace manycore::closing {

/// A reader of a topic DSM whose publisher is gone.
struct OrphanReader {
  const Cluster & cluster;  ///< of the topic DSM
  TopicDsmHeader & dsm;
  SubscriptionHeader & subscription;
  SourceEntry & source;
  const EndpointEntry & endpoint;  ///< of the subscription
  uint32_t endpoint_slot;
  uint32_t source_index;
};

/// The reader of a reader table's entry, or nothing if the entry is invalid. Throws
/// ClusterUnmappable.
std::optional<OrphanReader> orphan_reader(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & entry);

/// The newest record that a reader has not taken. As in Source::list_waiting(), no record of a
/// source counts as older than an earlier one.
struct Undelivered {
  uint64_t number;
  int64_t source_timestamp_ns;
  uint32_t source;  ///< index in the source table
};

/// The searches below take as many turns as needed: one whose turn is over leaves in `place` where
/// the next turn goes on, for the same reader. A new search starts at {}.

/// Adds what a reader has not taken to `newest`, which stays empty if that is nothing. False if the
/// turn ended before.
bool add_undelivered(
  std::optional<Undelivered> & newest, const OrphanReader & reader, DescriptorPlace & place,
  Turn & turn);

/// Counts the records of another source that are not taken and newer than a record.
class NewerCount {
public:
  /// The count, or nothing if the turn ended before. Starts anew for another source.
  std::optional<uint32_t> go_on(
    const Undelivered & record, const Cluster & cluster, TopicDsmHeader & dsm,
    const SourceEntry & source, uint32_t index, Turn & turn);

  NewerCount() = default;

private:
  static constexpr uint64_t none = UINT64_MAX;

  NewerCount(uint32_t source, uint32_t incarnation) : source_(source), incarnation_(incarnation) {}

  uint32_t source_ = nothing;
  uint32_t incarnation_ = 0;
  DescriptorPlace place_{};
  uint64_t first_ = none;  ///< number of the first newer record
  bool knows_first_ = false;
  uint32_t count_ = 0;
};

/// True if the reader has not taken some record, in any generation. Of replies, only the client's
/// own count, unless their hint was displaced. Nothing if the turn ended before.
std::optional<bool> has_undelivered(
  const OrphanReader & reader, DescriptorPlace & place, Turn & turn);

/// As has_undelivered(), without a search if the topic DSM holds no replies: then also true if the
/// records have expired. The place is kept in the topic DSM.
std::optional<bool> may_have_undelivered(const OrphanReader & reader, Turn & turn);

/// True if the reader's session has no mover any more, nor a process that starts one: the last
/// process of the publisher's cluster has gone.
bool is_abandoned(Registry & registry, const OrphanReader & reader, Turn & turn);

/// True if a record that the reader has not taken is in its cluster, announced or not. Nothing if
/// the turn ended before.
std::optional<bool> has_arrived(
  Registry & registry, const OrphanReader & reader, DescriptorPlace & place, Turn & turn);

/// Counts what the reader has not taken as lost. Requires that nothing of the topic DSM can be
/// claimed any more.
void count_undelivered(Registry & registry, const OrphanReader & reader);

}  // namespace manycore::closing
