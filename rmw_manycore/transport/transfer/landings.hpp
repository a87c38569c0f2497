// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/registry.hpp"

/// Attaching and freeing landings. The caller holds the registry lock.
namespace manycore::landings {

/// Before a subscription in `receiver` is matched: the block that the creator of the endpoint has
/// to have in hand, so that the publisher's records have a place there. Nothing where they have
/// one, or are not transferred. `hand`: nullptr = empty. Throws Error{no_space} for a ninth
/// session, with the names of the eight.
std::optional<NeededBlock> find_place(
  Registry & registry, const EndpointEntry & publisher, TopicDsmHeader & dsm,
  const Cluster & receiver, const BlockInHand * hand);
/// Then, unless one is attached: attaches the retired landing or the one in hand. `cluster`: that
/// of the topic DSM.
void attach(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver, BlockInHand * hand);

/// Once a reader in `receiver` is in the reader table.
void count_reader(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;
void discount_reader(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;
/// Before all are counted anew.
void forget_readers(const Cluster & cluster, TopicDsmHeader & dsm) noexcept;

/// If no subscription of `receiver` reads the topic DSM any more: from here on no thread finds the
/// landing.
void retire_unread(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;

/// True while a landing waits for its publisher and all movers to be out of their phases.
bool has_retired(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;
/// Takes the retired landing up to be freed: no thread follows references to it any more.
void take_up_retired(
  const Cluster & cluster, TopicDsmHeader & dsm, const Cluster & receiver,
  BlockInHand & hand) noexcept;

/// Retires any landing of a topic DSM to which no reference leads any more. Returns its cluster, or
/// nullptr when none is left. Throws ClusterUnmappable.
const Cluster * retire_next(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm);

/// Rebuilding the maps of the clusters.
void mark_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept;

/// A publisher that was killed hands over nothing more: its readers need not wait for it.
void close_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept;

}  // namespace manycore::landings
