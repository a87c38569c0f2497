// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

/// Making and freeing landings. The caller holds the registry lock.
namespace manycore::landings {

/// Before a subscription in `receiver` is matched: gives the publisher's records a place there.
/// Nothing to do where they are not transferred. Throws Error{no_space}, for a ninth session with
/// the names of the eight.
void ensure(
  Registry & registry, const EndpointEntry & publisher, TopicDsmHeader & dsm, Cluster & receiver);

/// Once no subscription of `receiver` reads the topic DSM any more: from here on no thread finds
/// the landing. `cluster`: that of the topic DSM.
void retire(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;

/// True while a landing waits for its publisher and all movers to be out of their phases.
bool has_retired(const Cluster & cluster, TopicDsmHeader & dsm, uint32_t receiver) noexcept;
void free_retired(const Cluster & cluster, TopicDsmHeader & dsm, Cluster & receiver) noexcept;

/// With the topic DSM; false when none is left. Throws ClusterUnmappable.
bool free_one(Registry & registry, const Cluster & cluster, TopicDsmHeader & dsm);

/// Rebuilding the maps of the clusters.
void mark_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept;

/// A publisher that was killed hands over nothing more: its readers need not wait for it.
void close_all(Clusters & clusters, const Cluster & cluster, TopicDsmHeader & dsm) noexcept;

}  // namespace manycore::landings
