// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

/// Publishers that are closed and whose messages subscriptions may still take. The caller holds the
/// registry lock. All throw ClusterUnmappable. See docs/design/rows_seats_hands.md.
namespace manycore::orphans {

/// Gives a seat to each reader of the history that has none: it is owed all that is left of it, of
/// which no process counts losses. Called before the publisher's row is closed.
void give_seats_to_readers_of_history(
  Registry & registry, Cluster & cluster, EndpointEntry & publisher, TopicDsmHeader & dsm);

/// Asks the readers of publishers of a topic that have just been closed to look. Then cuts what the
/// subscriptions of the topic keep of closed publishers, down to their history: of those
/// that were closed last, as many as hold `depth` untaken messages; a KEEP_ALL subscription keeps
/// as many publishers as its queue holds hints. All that no subscription keeps become `freeing`.
/// Appends their slots.
void cut(Registry & registry, const char * topic, std::vector<uint32_t> & unwanted);

/// True while a subscription that is there looks at the topic DSM. Called after the row's state was
/// stored (seq_cst): later looks find that it is not there.
bool is_being_read(Registry & registry, const EndpointEntry & publisher, uint32_t slot);

/// Counts what the owners of seats have not taken as lost. Requires that no subscription can look
/// any more.
void count_undelivered(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm);

}  // namespace manycore::orphans
