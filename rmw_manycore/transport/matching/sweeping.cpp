// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/sweeping.hpp"

#include "transport/matching/closing.hpp"

namespace manycore::sweeping {
namespace {

constexpr uint64_t steps_of_a_slot = 1;
/// Steps without progress before a process returns to its own work: about 0.5 ms.
constexpr uint64_t max_idle_steps = 8 * Turn::steps;

/// True for an endpoint that a live process left closing because it could not map a cluster, or
/// that a process left whose threads are ending one by one. Endpoints of dead processes are left to
/// the reaper.
bool is_left_closing(Registry & registry, const EndpointEntry & entry) {
  return entry.slot.state.load() == SlotState::closing &&
         registry.processes().is_live(entry.process) &&
         registry.lifelines().is_locked(entry.process);
}

/// Closes an endpoint left closing; frees the memory and the slot of a closed endpoint. Throws
/// ClusterUnmappable.
Progress sweep_endpoint(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t slot, Turn & turn) {
  EndpointEntry & entry = registry.endpoints()[slot];
  if (is_left_closing(registry, entry) && !closing::close_some(registry, slot, false, turn)) {
    return Progress::turn_over;
  }
  if (!is_closed(entry.slot.state.load())) {
    return Progress::kept;
  }
  const Progress progress = entry.kind == EndpointKind::publisher
                              ? sweep_publisher(registry, wanted, pass, slot, turn)
                              : sweep_subscription(registry, entry, turn);
  if (progress == Progress::freed) {
    registry.endpoints().give_back(slot);
    --registry.header().closing_count;
  }
  return progress;
}

}  // namespace

bool Round::try_to_sweep(uint32_t slot, Turn & turn) {
  const bool is_fresh = turn.spent() < Turn::steps / 8;
  try {
    const Progress progress = sweep_endpoint(registry_, wanted_, pass_, slot, turn);
    if (progress == Progress::turn_over && leaves_long_looks_ && is_fresh && wanted_.is_looking()) {
      needs_reaper_ = true;
      return true;
    }
    has_freed_ = has_freed_ || progress == Progress::freed || progress == Progress::freed_some;
    needs_reaper_ = needs_reaper_ || progress == Progress::in_use;
    return progress != Progress::freed_some && progress != Progress::turn_over;
  } catch (const ClusterUnmappable &) {
    needs_reaper_ = true;
    return true;
  }
}

bool Round::sweep_some() {
  Turn turn;
  has_freed_ = false;
  const bool looked_at_all = sweep_until(turn);
  idle_steps_ = has_freed_ ? 0 : idle_steps_ + turn.spent();
  return looked_at_all;
}

/// Continues with the endpoint that the last turn left unfinished: what a look has found is known
/// to this round only. Then goes on where the last round of any process ended.
bool Round::sweep_until(Turn & turn) {
  RegistryHeader & header = registry_.header();
  const uint32_t end = registry_.endpoints().high_water();
  for (; header.closing_count != 0 && looked_at_ < end; ++looked_at_) {
    if (turn.is_over()) {
      return false;
    }
    turn.spend(steps_of_a_slot);
    const uint32_t next = header.sweep_from < end ? header.sweep_from : 0;
    const uint32_t slot = unfinished_.value_or(next);
    if (!try_to_sweep(slot, turn)) {
      unfinished_ = slot;
      return false;
    }
    unfinished_.reset();
    header.sweep_from = slot == next ? slot + 1 : next;  // another process may have gone on
  }
  return true;
}

bool Round::sweep_some_of(uint32_t endpoint) {
  Turn turn;
  return try_to_sweep(endpoint, turn);
}

void sweep_all(Registry & registry) {
  Round round(registry);
  for (bool over = false; !over;) {
    const Registry::Lock lock(registry);
    over = round.sweep_some();
  }
}

/// What a look has found is forgotten with its round, so that looks of more turns than it has would
/// never end, and nothing behind them be freed.
void sweep_a_little(Registry & registry, uint32_t cluster, long wait_ns) {
  Round round(registry);
  round.leave_long_looks();
  bool over = false;
  while (!over && round.idle_steps() < max_idle_steps) {
    const Registry::Lock lock(registry, wait_ns);
    over = round.sweep_some();
  }
  if (!over || round.needs_reaper()) {
    registry.clusters().at(cluster).wake_reaper();
  }
}

void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept {
  try {
    Round round(registry);
    const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
    if (round.sweep_some_of(endpoint) && !round.needs_reaper()) {
      return;
    }
  } catch (const std::exception &) {
    // Another process holds the registry lock, and the caller must not wait for it.
  }
  cluster.wake_reaper();
}

}  // namespace manycore::sweeping
