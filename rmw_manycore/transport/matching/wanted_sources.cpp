// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/wanted_sources.hpp"

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore::sweeping {
namespace {

using closing::OrphanReader;
using closing::Undelivered;

constexpr uint64_t steps_of_a_source = 3;
constexpr uint64_t looks_at_other = 2;  ///< count_newer_than() visits each record twice

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

void spend_on(TopicDsmHeader & dsm, const SourceEntry & source, uint64_t looks, Turn & turn) {
  turn.spend(looks * closing::records_to_look_at(dsm, source) / Turn::records_in_a_step);
}

}  // namespace

WantedSources::Look WantedSources::look_at(
  const OrphanReader & reader, const Undelivered & newest) const {
  const uint32_t incarnation = reader.endpoint.slot.incarnation.load();
  const bool is_same = last_ && last_->endpoint == reader.endpoint_slot &&
                       last_->incarnation == incarnation && last_->record.source == newest.source &&
                       last_->record.number == newest.number;
  return is_same ? *last_
                 : Look{reader.endpoint_slot, incarnation, taken_by(reader.endpoint), newest, 0, 0};
}

bool WantedSources::count_newer(Look & look, const OrphanReader & reader, Turn & turn) const {
  const uint32_t first = look.next;
  bool is_over = false;
  const auto visit = [&](SourceEntry & source, uint32_t index) {
    // Each turn makes progress, whatever it spent before.
    is_over = turn.is_over() && index != first;
    if (is_over || look.newer >= reader.subscription.depth) {
      return true;
    }
    look.next = index + 1;
    turn.spend(steps_of_a_source);
    TopicDsmHeader * const dsm =
      source.state.load() == SourceState::active ? topic_dsm_of(registry_, source) : nullptr;
    if (dsm != nullptr) {
      spend_on(*dsm, source, looks_at_other, turn);
      const uint32_t cluster = SegmentRef{source.topic_dsm.load()}.cluster();
      look.newer += closing::count_newer_than(
        look.record, registry_.clusters().at(cluster), *dsm, source, index);
    }
    return false;
  };
  source_table(registry_.clusters().at(reader.endpoint.cluster), reader.subscription)
    .visit(first, visit);
  return !is_over;
}

/// A subscription that took a message since the check began may want more than the check found. It
/// takes what it wants itself, so the topic DSM stays for now.
std::optional<bool> WantedSources::contain(const OrphanReader & reader, Turn & turn) {
  spend_on(reader.dsm, reader.source, 1, turn);
  if (!is_cut_by_depth(reader)) {
    return closing::has_undelivered(reader);
  }
  const std::optional<Undelivered> newest =
    closing::newest_undelivered(reader.cluster, reader.dsm, reader.source, reader.source_index);
  if (!newest) {
    return false;
  }
  Look look = look_at(reader, *newest);
  last_.reset();
  if (!count_newer(look, reader, turn)) {
    last_ = look;
    return std::nullopt;
  }
  return look.taken != taken_by(reader.endpoint) || look.newer < reader.subscription.depth;
}

}  // namespace manycore::sweeping
