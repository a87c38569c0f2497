// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "transport/matching/freeing.hpp"
#include "transport/matching/turn.hpp"
#include "transport/matching/wanted_sources.hpp"
#include "transport/registry/registry.hpp"

/// Frees what closed endpoints hold, as soon as no process can be using it (see
/// docs/design/freeing.md), and closes endpoints that a live process could not close
/// because it could not map a cluster. Works in turns, between which other processes get the
/// registry lock. Progress is kept in shared memory, so any process continues where another one
/// stopped or died.
namespace manycore::sweeping {

/// One check of all closed endpoints, in as many turns as needed.
class Round {
public:
  explicit Round(Registry & registry) noexcept : registry_(registry), wanted_(registry) {}
  /// For a process with work of its own: the round ends after a few looks that free nothing, and
  /// passes over an endpoint whose records take more than a turn to look at. What a look has found
  /// is forgotten with its round, so it would never end in rounds of fewer turns than it takes.
  void be_brief() noexcept { is_brief_ = true; }

  /// One turn. True when the round is over. The caller holds the registry lock.
  bool sweep_some();
  /// One turn for one endpoint. True when its check is complete. The caller holds the lock.
  bool sweep_some_of(uint32_t endpoint);
  /// True if an endpoint is left that no process is sure to sweep by itself: this one could not map
  /// a cluster or left a look, or another one was accessing the memory.
  bool needs_reaper() const noexcept { return needs_reaper_; }

private:
  std::optional<uint32_t> next_closing();
  /// False if the turn ended before the check was complete.
  bool try_to_sweep(uint32_t slot, Turn & turn);

  Registry & registry_;
  WantedSources wanted_;
  ReaderPass pass_;
  uint32_t passed_slots_ = 0;             ///< checked, or not closing
  std::optional<uint32_t> unfinished_{};  ///< slot with which the next turn begins
  uint32_t idle_looks_ = 0;               ///< since the last one that freed memory
  bool needs_reaper_ = false;
  bool is_brief_ = false;
};

/// A complete round. Takes the registry lock anew for each turn.
void sweep_all(Registry & registry);

/// Sweeps a brief round for a process of `cluster` that creates or closes an endpoint: what is kept
/// costs each of them the same, however much it is. Wakes the cluster's reaper if needed (see
/// Round::needs_reaper()).
void sweep_a_little(
  Registry & registry, uint32_t cluster, long wait_ns = Registry::Lock::usual_wait_ns);

/// One turn for one endpoint, if it is closed. Never waits for the registry lock. Wakes the reaper
/// of `cluster` for what is then left (see Round::needs_reaper()).
void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept;

}  // namespace manycore::sweeping
