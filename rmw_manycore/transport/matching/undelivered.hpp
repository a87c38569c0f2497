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

/// Nothing if all records are taken.
std::optional<Undelivered> newest_undelivered(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source, uint32_t index);

/// Number of records of another source that are not taken and newer than `record`.
uint32_t count_newer_than(
  const Undelivered & record, const Cluster & cluster, TopicDsmHeader & dsm,
  const SourceEntry & source, uint32_t index);

/// Number of descriptors that one search for undelivered records visits.
uint64_t records_to_look_at(TopicDsmHeader & dsm, const SourceEntry & source);

/// True if the reader has not taken some record, in any generation. Of replies, only the client's
/// own count, unless their hint was displaced.
bool has_undelivered(const OrphanReader & reader);

/// As has_undelivered(), without a search if the topic DSM holds no replies: then also true if the
/// records have expired. Nothing if the turn ended before the answer was found: ask for the same
/// reader in the next turn, which continues at `looked_before`.
std::optional<bool> may_have_undelivered(const OrphanReader & reader, Turn & turn);

/// True if the reader's session has no mover any more, nor a process that starts one: the last
/// process of the publisher's cluster has gone.
bool is_abandoned(Registry & registry, const OrphanReader & reader, Turn & turn);

/// True if a record that the reader has not taken is in its cluster, announced or not.
bool has_arrived(Registry & registry, const OrphanReader & reader);

/// Counts what the reader has not taken as lost. Requires that nothing of the topic DSM can be
/// claimed any more.
void count_undelivered(Registry & registry, const OrphanReader & reader);

}  // namespace manycore::closing
