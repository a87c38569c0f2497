// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/hinted_sources.hpp"

#include "transport/queue/subscriber_queue.hpp"

namespace manycore::sweeping {
namespace {

constexpr uint64_t hints_in_a_step = 8;

}  // namespace

HintedSources hinted_sources(
  Registry & registry, const closing::OrphanReader & reader, Turn & turn) {
  HintedSources found;
  SubscriptionHeader & subscription = reader.subscription;
  if (
    registry.clusters().find<SubscriptionHeader>(
      reader.endpoint.block, block_bytes(subscription)) != &subscription) {
    return found;
  }
  turn.spend(1 + std::min<uint64_t>(subscription.depth, HintedSources::most) / hints_in_a_step);
  const uint64_t taken = reader.source.taken.load(std::memory_order_acquire);
  const uint64_t last = reader.dsm.last.load(std::memory_order_acquire);
  const uint32_t incarnation = reader.source.incarnation.load(std::memory_order_relaxed);
  subscriber_queue::visit_newest(subscription, HintedSources::most, [&](const Hint & hint) {
    if (hint.source != reader.source_index) {
      found.add_other(hint.source);
    } else if (hint.is_of(incarnation)) {
      const uint64_t number = Hint::full_number(hint.number, last);
      found.is_own = found.is_own || (number > taken && number <= last);
    }
  });
  return found;
}

}  // namespace manycore::sweeping
