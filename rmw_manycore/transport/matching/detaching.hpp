// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// Frees an entry of a reader table. The caller holds the registry lock.
void remove_reader(const Cluster & cluster, TopicDsmHeader & dsm, ReaderEntry & reader) noexcept;

/// Removes the reader of a source in cluster `receiver` from its topic DSM's reader table, and
/// retires the landing that it was the last to read. The caller holds the registry lock. Throws
/// ClusterUnmappable before anything is changed.
void detach_reader(Registry & registry, SourceEntry & source, uint32_t receiver);

}  // namespace manycore
