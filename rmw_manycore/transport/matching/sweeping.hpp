// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/matching/freeing.hpp"
#include "transport/matching/turn.hpp"
#include "transport/matching/wanted_sources.hpp"
#include "transport/registry/registry.hpp"

/// Frees what closed endpoints hold, as far as no process can be using it any more (see
/// docs/design/topic_dsm.md, Freeing), and closes what a living process could not, as a cluster was
/// out of its reach. In turns, between which the registry lock goes to others: how far it has come
/// is in shared memory, so any process goes on where another one stopped or died.
namespace manycore::sweeping {

/// One look at all endpoints, by as many turns as it takes.
class Round {
public:
  explicit Round(Registry & registry) noexcept : registry_(registry), wanted_(registry) {}

  /// One turn; the caller holds the registry lock. True when every endpoint was looked at.
  bool sweep_some();
  /// One turn for one endpoint; the caller holds the lock. True when it was looked at whole.
  bool sweep_some_of(uint32_t endpoint);
  /// False when something is out of this process's reach, and left to others.
  bool reached_all() const noexcept { return reached_all_; }

private:
  /// False when the turn is over before the endpoint was looked at.
  bool try_to_sweep(uint32_t slot, Turn & turn);

  Registry & registry_;
  WantedSources wanted_;
  ReaderPass pass_;
  uint32_t looked_at_ = 0;  ///< slots
  bool reached_all_ = true;
};

/// A whole round; takes the registry lock anew for each turn.
void sweep_all(Registry & registry);

/// For a process of `cluster` that is creating or closing an endpoint: a round that ends early,
/// after a few turns that free nothing. The cluster's reaper is woken for what is left then, or out
/// of this process's reach.
void sweep_a_little(
  Registry & registry, uint32_t cluster, long wait_ns = Registry::Lock::usual_wait_ns);

/// One turn for one endpoint, if there is such a closed one. Does not wait for the registry lock.
/// The reaper of `cluster` is woken for what is left then, or out of this process's reach.
void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept;

}  // namespace manycore::sweeping
