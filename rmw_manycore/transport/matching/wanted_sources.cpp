// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/wanted_sources.hpp"

#include "transport/matching/hinted_sources.hpp"
#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore::sweeping {
namespace {

using closing::OrphanReader;

constexpr uint64_t steps_of_a_source = 3;

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

uint32_t WantedSources::newer_in_hinted(
  Look & look, const OrphanReader & reader, const HintedSources & hinted, Turn & turn) const {
  const auto sources =
    source_table(registry_.clusters().at(reader.endpoint.cluster), reader.subscription);
  uint32_t newer = 0;
  for (size_t i = 0; i < hinted.other_count && newer < reader.subscription.depth; ++i) {
    SourceEntry * const source = sources.find(hinted.others[i]);
    if (turn.is_over() || source == nullptr) {
      break;
    }
    newer += newer_in(look, *source, hinted.others[i], turn).value_or(0);
  }
  return newer < reader.subscription.depth ? 0 : newer;
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
  if (look.hint_turns_left > 0) {
    --look.hint_turns_left;
    const HintedSources hinted = hinted_sources(registry_, reader, turn);
    if (hinted.is_own) {
      return true;
    }
    look.newer = newer_in_hinted(look, reader, hinted, turn);
    if (look.newer == 0 && turn.is_over() && look.hint_turns_left > 0) {
      return std::nullopt;
    }
    look.hint_turns_left = 0;
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
