// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/wanted_sources.hpp"

#include <algorithm>
#include <utility>

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore::sweeping {
namespace {

using closing::OrphanReader;

constexpr uint64_t steps_of_a_source = 3;
constexpr uint64_t hints_in_a_step = 16;

/// Messages that the subscription itself removed: taken or expired.
uint64_t taken_by(const EndpointEntry & subscription) {
  const EndpointCounters & counters = subscription.counters;
  return counters.messages.load(std::memory_order_acquire) +
         counters.expired.load(std::memory_order_acquire);
}

bool is_cut_by_depth(const OrphanReader & reader) {
  return reader.subscription.keep_all == 0 &&
         static_cast<EndpointRole>(reader.dsm.role) != EndpointRole::reply;
}

Announced announced_by_hints(const OrphanReader & reader, Turn & turn) {
  Announced found;
  turn.spend(1 + std::min<uint64_t>(reader.subscription.depth, most_announced) / hints_in_a_step);
  const uint64_t taken = reader.source.taken.load(std::memory_order_acquire);
  const uint64_t last = reader.dsm.last.load(std::memory_order_acquire);
  const uint32_t incarnation = reader.source.incarnation.load(std::memory_order_relaxed);
  subscriber_queue::visit_newest(reader.subscription, most_announced, [&](const Hint & hint) {
    if (hint.source != reader.source_index) {
      found.add_other(hint.source);
    } else if (hint.source_incarnation == (incarnation & Hint::incarnation_mask)) {
      const uint64_t ahead = (hint.number - taken) & Hint::number_mask;
      found.is_own = found.is_own || (ahead != 0 && ahead <= last - std::min(taken, last));
    }
  });
  return found;
}

}  // namespace

bool WantedSources::Look::is_at(const OrphanReader & reader) const noexcept {
  return endpoint == reader.endpoint_slot &&
         incarnation == reader.endpoint.slot.incarnation.load() && source == reader.source_index &&
         source_incarnation == reader.source.incarnation.load();
}

WantedSources::Look WantedSources::Look::at(const OrphanReader & reader) noexcept {
  return {
    reader.endpoint_slot, reader.endpoint.slot.incarnation.load(), reader.source_index,
    reader.source.incarnation.load(), taken_by(reader.endpoint)};
}

std::optional<uint32_t> WantedSources::newer_in(
  Look & look, SourceEntry & source, uint32_t index, Turn & turn) const {
  turn.spend(steps_of_a_source);
  TopicDsmHeader * const dsm =
    source.state.load() == SourceState::active ? topic_dsm_of(registry_, source) : nullptr;
  if (dsm == nullptr) {
    return 0;
  }
  const Cluster & cluster = registry_.clusters().at(SegmentRef{source.topic_dsm.load()}.cluster());
  return look.in_next.go_on(*look.newest, cluster, *dsm, source, index, turn);
}

uint32_t WantedSources::newer_in_announced(
  Look & look, const OrphanReader & reader, const Announced & announced, Turn & turn) const {
  const auto sources =
    source_table(registry_.clusters().at(reader.endpoint.cluster), reader.subscription);
  uint32_t newer = 0;
  for (size_t i = 0; i < announced.other_count && newer < reader.subscription.depth; ++i) {
    SourceEntry * const source = sources.find(announced.others[i]);
    if (turn.is_over() || source == nullptr) {
      break;
    }
    newer += newer_in(look, *source, announced.others[i], turn).value_or(0);
  }
  return newer;
}

bool WantedSources::count_newer(Look & look, const OrphanReader & reader, Turn & turn) const {
  bool is_over = false;
  const auto visit = [&](SourceEntry & source, uint32_t index) {
    is_over = turn.is_over();
    if (is_over || look.newer >= reader.subscription.depth) {
      return true;
    }
    const std::optional<uint32_t> newer = newer_in(look, source, index, turn);
    is_over = !newer;
    look.newer += newer.value_or(0);
    look.next = is_over ? index : index + 1;
    return is_over;
  };
  source_table(registry_.clusters().at(reader.endpoint.cluster), reader.subscription)
    .visit(look.next, visit);
  return !is_over;
}

/// A subscription that took a message since the check began may want more than the check found. It
/// takes what it wants itself, so the topic DSM stays for now.
std::optional<bool> WantedSources::is_among_newest(
  Look & look, const OrphanReader & reader, Turn & turn) const {
  if (!is_cut_by_depth(reader)) {
    return closing::has_undelivered(reader, look.place, turn);
  }
  if (!look.knows_newest) {
    look.knows_newest = closing::add_undelivered(look.newest, reader, look.place, turn);
  }
  if (!look.knows_newest) {
    return std::nullopt;
  }
  if (!look.newest) {
    return false;
  }
  if (!std::exchange(look.has_seen_hints, true)) {
    const Announced announced = announced_by_hints(reader, turn);
    if (announced.is_own) {
      return true;
    }
    const uint32_t newer = newer_in_announced(look, reader, announced, turn);
    look.newer = newer < reader.subscription.depth ? 0 : newer;  // else counted with all others
  }
  if (!count_newer(look, reader, turn)) {
    return std::nullopt;
  }
  return look.taken != taken_by(reader.endpoint) || look.newer < reader.subscription.depth;
}

/// What a dead mover left without a hint, the reader is asked to look for.
std::optional<bool> WantedSources::is_to_be_had(
  Look & look, const OrphanReader & reader, Turn & turn) const {
  if (!closing::is_abandoned(registry_, reader, turn)) {
    return true;
  }
  const std::optional<bool> is_there = closing::has_arrived(registry_, reader, look.place, turn);
  if (is_there.value_or(false)) {
    reader.subscription.resync.store(1, std::memory_order_seq_cst);
    notify_watchers(registry_, reader.subscription);
  }
  return is_there;
}

std::optional<bool> WantedSources::contain(const OrphanReader & reader, Turn & turn) {
  if (!look_ || !look_->is_at(reader)) {
    look_ = Look::at(reader);
  }
  if (!look_->is_wanted) {
    look_->is_wanted = is_among_newest(*look_, reader, turn);
  }
  std::optional<bool> found = look_->is_wanted;
  if (found.value_or(false)) {
    found = is_to_be_had(*look_, reader, turn);
  }
  if (found) {
    look_.reset();
  }
  return found;
}

}  // namespace manycore::sweeping
