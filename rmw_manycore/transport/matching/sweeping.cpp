// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/sweeping.hpp"

#include <vector>

#include "transport/matching/closing.hpp"
#include "transport/matching/freeing.hpp"

namespace manycore::sweeping {
namespace {

using freeing::Progress;

/// True for an endpoint that a live process left closing because it could not map a cluster, or
/// that a process left whose threads are ending one by one. Endpoints of dead processes are left to
/// the reaper.
bool is_left_closing(Registry & registry, const EndpointEntry & entry) {
  return entry.slot.state.load() == SlotState::closing &&
         registry.processes().is_live(entry.process) &&
         registry.lifelines().is_locked(entry.process);
}

/// Closes an endpoint left closing; takes up memory of a closed one, and frees its slot once none
/// is left. The caller holds the registry lock.
Progress sweep_some(Registry & registry, uint32_t slot, BlockInHand & hand) {
  EndpointEntry & entry = registry.endpoints()[slot];
  try {
    if (is_left_closing(registry, entry)) {
      std::vector<uint32_t> unread;  // the reaper, which does this, looks at all
      closing::close(registry, slot, false, unread);
    }
    if (!is_closed(entry.slot.state.load())) {
      return Progress::kept;
    }
    const Progress progress = entry.kind == EndpointKind::publisher
                                ? freeing::free_publisher(registry, slot, hand)
                                : freeing::free_subscription(registry, slot, hand);
    if (progress == Progress::none_left) {
      registry.endpoints().give_back(slot);
      registry.header().closing.remove(slot);
      --registry.header().closing_count;
    }
    return progress;
  } catch (const ClusterUnmappable &) {
    return Progress::in_use;
  }
}

Result result_of(Progress progress) {
  return progress == Progress::none_left ? Result::freed
         : progress == Progress::in_use  ? Result::in_use
                                         : Result::kept;
}

}  // namespace

/// The hand outlives the lock, so it is emptied without it.
Result sweep(Registry & registry, uint32_t endpoint, long wait_ns) {
  while (true) {
    BlockInHand hand(registry, wait_ns);
    const Registry::Lock lock(registry, wait_ns);
    const Progress progress = sweep_some(registry, endpoint, hand);
    if (progress != Progress::some_left) {
      return result_of(progress);
    }
  }
}

bool sweep_all(Registry & registry) {
  std::vector<uint32_t> closing;
  registry.header().closing.for_each([&](uint32_t slot) { closing.push_back(slot); });
  bool is_any_in_use = false;
  for (const uint32_t slot : closing) {
    is_any_in_use = sweep(registry, slot) == Result::in_use || is_any_in_use;
  }
  return is_any_in_use;
}

void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept {
  try {
    while (std::optional<BlockInHand> hand = BlockInHand::try_make(registry)) {
      const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
      const Progress progress = sweep_some(registry, endpoint, *hand);
      if (progress != Progress::some_left) {
        if (progress == Progress::in_use) {
          break;
        }
        return;
      }
    }
  } catch (const std::exception &) {
    // Another process holds the registry lock, and the caller must not wait for it.
  }
  cluster.wake_reaper();
}

}  // namespace manycore::sweeping
