// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
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

/// The reader behind an entry of a reader table, or nothing when the entry leads nowhere. Throws
/// OutOfReach.
std::optional<OrphanReader> orphan_reader(
  Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm, const ReaderEntry & entry);

/// The newest record that a reader has not taken. No record of a source counts as older than an
/// earlier one, as in Source::list_waiting().
struct Undelivered {
  uint64_t number;
  int64_t source_timestamp_ns;
  uint32_t source;  ///< index
};

/// Nothing when all is taken.
std::optional<Undelivered> newest_undelivered(
  const Cluster & cluster, TopicDsmHeader & dsm, const SourceEntry & source, uint32_t index);

/// Records of another source that it has not taken and that are newer than `record`.
uint32_t count_newer_than(
  const Undelivered & record, const Cluster & cluster, TopicDsmHeader & dsm,
  const SourceEntry & source, uint32_t index);

/// Records that one look for undelivered ones goes through.
uint64_t records_to_look_at(TopicDsmHeader & dsm, const SourceEntry & source);

/// A record that the reader has not taken, in any generation; of replies, its own whose hint was
/// not displaced.
bool has_undelivered(const OrphanReader & reader);

/// Counts what the reader has not taken as lost; nothing of the topic DSM may be claimed any more.
void count_undelivered(Registry & registry, const OrphanReader & reader);

}  // namespace manycore::closing
