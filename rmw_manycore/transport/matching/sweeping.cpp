// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/sweeping.hpp"

#include "transport/matching/closing.hpp"

namespace manycore::sweeping {
namespace {

constexpr uint64_t steps_of_a_slot = 1;
constexpr uint64_t steps_of_freeing = 256;  ///< a few system calls
/// Turns that free nothing, of a process that is about something else: 0.5 ms.
constexpr int most_idle_turns = 8;

/// Left by a process that lives, as a cluster was out of its reach; or by one that is dying, thread
/// by thread. What the dead leave is the reaper's.
bool is_left_closing(Registry & registry, const EndpointEntry & entry) {
  return entry.slot.state.load() == SlotState::closing &&
         registry.processes().is_live(entry.process) && registry.lifelines().is_held(entry.process);
}

/// Closes what is left closing; frees the memory of a closed endpoint, and its slot. Throws
/// OutOfReach.
Progress sweep_endpoint(
  Registry & registry, WantedSources & wanted, ReaderPass & pass, uint32_t slot, Turn & turn) {
  EndpointEntry & entry = registry.endpoints()[slot];
  if (is_left_closing(registry, entry) && !closing::close_some(registry, slot, false, turn)) {
    return Progress::turn_over;
  }
  const SlotState state = entry.slot.state.load();
  if (state != SlotState::closed && state != SlotState::freeing) {
    return Progress::blocked;
  }
  const Progress progress = entry.kind == EndpointKind::publisher
                              ? sweep_publisher(registry, wanted, pass, slot, turn)
                              : sweep_subscription(registry, entry, turn);
  if (progress == Progress::freed) {
    turn.spend(steps_of_freeing);
    registry.endpoints().give_back(slot);
    --registry.header().closing_count;
  }
  return progress;
}

}  // namespace

bool Round::try_to_sweep(uint32_t slot, Turn & turn) {
  try {
    return sweep_endpoint(registry_, wanted_, pass_, slot, turn) != Progress::turn_over;
  } catch (const OutOfReach &) {
    reached_all_ = false;
    return true;
  }
}

/// Goes on where the last round of any process ended.
bool Round::sweep_some() {
  RegistryHeader & header = registry_.header();
  const uint32_t end = registry_.endpoints().high_water();
  for (Turn turn; header.closing_count != 0 && looked_at_ < end; ++looked_at_) {
    if (turn.is_over()) {
      return false;
    }
    turn.spend(steps_of_a_slot);
    const uint32_t slot = header.sweep_from < end ? header.sweep_from : 0;
    if (!try_to_sweep(slot, turn)) {
      return false;
    }
    header.sweep_from = slot + 1;
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

void sweep_a_little(Registry & registry, uint32_t cluster, long wait_ns) {
  Round round(registry);
  bool over = false;
  for (int idle_turns = 0; !over && idle_turns < most_idle_turns;) {
    const Registry::Lock lock(registry, wait_ns);
    const uint32_t before = registry.header().closing_count;
    over = round.sweep_some();
    idle_turns = registry.header().closing_count < before ? 0 : idle_turns + 1;
  }
  if (!over || !round.reached_all()) {
    registry.clusters().at(cluster).wake_reaper();
  }
}

void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept {
  try {
    Round round(registry);
    const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
    if (round.sweep_some_of(endpoint) && round.reached_all()) {
      return;
    }
  } catch (const std::exception &) {
    // Another process holds the registry, and the caller does not wait for it.
  }
  cluster.wake_reaper();
}

}  // namespace manycore::sweeping
