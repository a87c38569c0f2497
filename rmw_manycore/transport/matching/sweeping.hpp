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

/// One check of all endpoints, in as many turns as needed.
class Round {
public:
  explicit Round(Registry & registry) noexcept : registry_(registry), wanted_(registry) {}
  /// From now on passes over an endpoint whose records take more than a turn to look at.
  void leave_long_looks() noexcept { leaves_long_looks_ = true; }

  /// One turn. True when all endpoints were checked. The caller holds the registry lock.
  bool sweep_some();
  /// One turn for one endpoint. True when its check is complete. The caller holds the lock.
  bool sweep_some_of(uint32_t endpoint);
  /// True if an endpoint is left that no process is sure to sweep by itself: this one could not map
  /// a cluster or left a long look, or another one was accessing the memory.
  bool needs_reaper() const noexcept { return needs_reaper_; }
  /// Steps since this round last freed memory.
  uint64_t idle_steps() const noexcept { return idle_steps_; }

private:
  /// False if the turn ended before all endpoints were checked.
  bool sweep_until(Turn & turn);
  /// False if the turn ended before the check was complete.
  bool try_to_sweep(uint32_t slot, Turn & turn);

  Registry & registry_;
  WantedSources wanted_;
  ReaderPass pass_;
  uint32_t looked_at_ = 0;                ///< slots checked so far
  std::optional<uint32_t> unfinished_{};  ///< slot with which the next turn begins
  bool has_freed_ = false;                ///< in this turn
  uint64_t idle_steps_ = 0;
  bool needs_reaper_ = false;
  bool leaves_long_looks_ = false;
};

/// A complete round. Takes the registry lock anew for each turn.
void sweep_all(Registry & registry);

/// Sweeps one round for a process of `cluster` that creates or closes an endpoint. Ends early after
/// about 0.5 ms without progress, and leaves long looks. Wakes the cluster's reaper for endpoints
/// that are then left (see Round::needs_reaper()).
void sweep_a_little(
  Registry & registry, uint32_t cluster, long wait_ns = Registry::Lock::usual_wait_ns);

/// One turn for one endpoint, if it is closed. Never waits for the registry lock. Wakes the reaper
/// of `cluster` for what is then left (see Round::needs_reaper()).
void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept;

}  // namespace manycore::sweeping
