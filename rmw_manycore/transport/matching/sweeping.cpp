// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/sweeping.hpp"

#include "transport/matching/closing.hpp"

namespace manycore::sweeping {
namespace {

constexpr uint64_t steps_of_a_slot = 1;
/// Looks in a row that freed nothing, after which a process returns to its own work: a few
/// microseconds, and at most as many turns.
constexpr uint32_t max_idle_looks = 8;

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
    registry.header().closing.remove(slot);
    --registry.header().closing_count;
  }
  return progress;
}

}  // namespace

bool Round::try_to_sweep(uint32_t slot, Turn & turn) {
  const bool is_fresh = turn.spent() < Turn::steps / 8;
  try {
    const Progress progress = sweep_endpoint(registry_, wanted_, pass_, slot, turn);
    const bool has_freed = progress == Progress::freed || progress == Progress::freed_some;
    idle_looks_ = has_freed ? 0 : idle_looks_ + 1;
    if (progress == Progress::turn_over && is_brief_ && is_fresh && wanted_.is_looking()) {
      needs_reaper_ = true;
      return true;
    }
    needs_reaper_ = needs_reaper_ || progress == Progress::in_use;
    return progress != Progress::freed_some && progress != Progress::turn_over;
  } catch (const ClusterUnmappable &) {
    ++idle_looks_;
    needs_reaper_ = true;
    return true;
  }
}

/// The next closed endpoint, from where the last round of any process ended. Nothing once this
/// round has passed all slots.
std::optional<uint32_t> Round::next_closing() {
  RegistryHeader & header = registry_.header();
  const uint32_t end = registry_.endpoints().high_water();
  const uint32_t from = header.sweep_from < end ? header.sweep_from : 0;
  const std::optional<uint32_t> next =
    header.closing_count == 0 ? std::nullopt : header.closing.next(from, end);
  if (!next) {
    return std::nullopt;
  }
  passed_slots_ += *next >= from ? *next - from + 1 : *next + end - from + 1;
  return passed_slots_ > end ? std::nullopt : next;
}

/// Begins with the endpoint that the last turn left unfinished: what a look has found is known to
/// this round only.
bool Round::sweep_some() {
  Turn turn;
  while (!is_brief_ || idle_looks_ < max_idle_looks) {
    if (turn.is_over()) {
      return false;
    }
    turn.spend(steps_of_a_slot);
    if (!unfinished_) {
      unfinished_ = next_closing();
      if (!unfinished_) {
        return true;
      }
      registry_.header().sweep_from = *unfinished_ + 1;
    }
    if (!try_to_sweep(*unfinished_, turn)) {
      return false;
    }
    unfinished_.reset();
  }
  needs_reaper_ = needs_reaper_ || unfinished_;
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
  round.be_brief();
  for (bool over = false; !over;) {
    const Registry::Lock lock(registry, wait_ns);
    over = round.sweep_some();
  }
  if (round.needs_reaper()) {
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
