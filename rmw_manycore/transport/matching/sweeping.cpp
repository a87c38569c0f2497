// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/sweeping.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_set>
#include <vector>

#include "transport/matching/freeing.hpp"

namespace manycore::sweeping {
namespace {

using freeing::Progress;

/// Takes up memory of a closed endpoint, and frees its slot once none is left. The caller holds the
/// registry lock.
Progress sweep_some(
  Registry & registry, uint32_t slot, BlockInHand & hand, std::vector<uint32_t> & unwanted) {
  EndpointEntry & entry = registry.endpoints()[slot];
  try {
    if (!is_closed(entry.slot.state.load())) {
      return Progress::kept;
    }
    const Progress progress = entry.kind == EndpointKind::publisher
                                ? freeing::free_publisher(registry, slot, hand, unwanted)
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

/// The hand outlives the lock, so it is emptied without it.
Result sweep_one(
  Registry & registry, uint32_t endpoint, long wait_ns, std::vector<uint32_t> & unwanted) {
  while (true) {
    BlockInHand hand(registry, wait_ns);
    const Registry::Lock lock(registry, wait_ns);
    const Progress progress = sweep_some(registry, endpoint, hand, unwanted);
    if (progress != Progress::some_left) {
      return result_of(progress);
    }
  }
}

/// Without waiting. False if the reaper has to look.
bool try_one(Registry & registry, uint32_t endpoint, std::vector<uint32_t> & unwanted) {
  while (std::optional<BlockInHand> hand = BlockInHand::try_make(registry)) {
    const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
    const Progress progress = sweep_some(registry, endpoint, *hand, unwanted);
    if (progress != Progress::some_left) {
      return progress != Progress::in_use;
    }
  }
  return false;
}

void add_others(
  std::vector<uint32_t> & slots, uint32_t own, const std::vector<uint32_t> & unwanted) {
  std::copy_if(unwanted.begin(), unwanted.end(), std::back_inserter(slots), [&](uint32_t slot) {
    return slot != own;
  });
}

/// True if the topic of a closed publisher was cut before in the same sweep: the publisher is kept.
bool is_cut_before(Registry & registry, uint32_t slot, std::unordered_set<uint64_t> & topics) {
  const EndpointEntry & entry = registry.endpoints()[slot];
  return entry.kind == EndpointKind::publisher && entry.slot.state.load() == SlotState::closed &&
         !topics.insert(hash_name(text_of(entry.topic).c_str())).second;
}

}  // namespace

/// What the endpoint's topic keeps no longer goes with it.
Result sweep(Registry & registry, uint32_t endpoint, long wait_ns) {
  std::vector<uint32_t> slots{endpoint};
  Result result = Result::freed;
  for (size_t i = 0; i < slots.size(); ++i) {
    std::vector<uint32_t> unwanted;
    const Result of_this = sweep_one(registry, slots[i], wait_ns, unwanted);
    result = i == 0 || of_this == Result::in_use ? of_this : result;
    add_others(slots, slots[i], unwanted);
  }
  return result;
}

bool sweep_all(Registry & registry) {
  std::vector<uint32_t> closing;
  registry.header().closing.for_each([&](uint32_t slot) { closing.push_back(slot); });
  std::unordered_set<uint64_t> topics;
  bool is_any_in_use = false;
  for (const uint32_t slot : closing) {
    if (!is_cut_before(registry, slot, topics)) {
      is_any_in_use = sweep(registry, slot) == Result::in_use || is_any_in_use;
    }
  }
  return is_any_in_use;
}

void try_to_sweep(Registry & registry, uint32_t endpoint, const Cluster & cluster) noexcept {
  bool is_done = true;
  try {
    std::vector<uint32_t> slots{endpoint};
    for (size_t i = 0; i < slots.size(); ++i) {
      std::vector<uint32_t> unwanted;
      is_done = try_one(registry, slots[i], unwanted) && is_done;
      add_others(slots, slots[i], unwanted);
    }
  } catch (const std::exception &) {
    is_done = false;  // another process holds the registry lock, which the caller must not wait for
  }
  if (!is_done) {
    cluster.wake_reaper();
  }
}

}  // namespace manycore::sweeping
