// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/matching/wanted_sources.hpp"

#include <algorithm>

#include "transport/queue/source_table.hpp"
#include "transport/registry/endpoint_blocks.hpp"

namespace manycore::sweeping {
namespace {

using closing::OrphanReader;
using closing::Undelivered;

constexpr uint64_t steps_of_a_source = 3;

/// Messages that left the subscription by itself.
uint64_t taken_by(const EndpointEntry & subscription) {
  const EndpointCounters & counters = subscription.counters;
  return counters.messages.load(std::memory_order_acquire) +
         counters.expired.load(std::memory_order_acquire);
}

bool is_cut_by_depth(const OrphanReader & reader) {
  return reader.subscription.keep_all == 0 &&
         static_cast<EndpointRole>(reader.dsm.role) != EndpointRole::reply;
}

void cut(std::vector<Undelivered> & records, uint32_t depth) {
  if (records.size() > depth) {
    const auto end = records.begin() + static_cast<ptrdiff_t>(depth);
    std::nth_element(
      records.begin(), end, records.end(),
      [](const Undelivered & a, const Undelivered & b) { return a.is_newer_than(b); });
    records.erase(end, records.end());
  }
}

}  // namespace

WantedSources::Look & WantedSources::look_of(const OrphanReader & reader) {
  Look & look = looks_[reader.endpoint_slot];
  const uint32_t incarnation = reader.endpoint.slot.incarnation.load();
  const bool is_fresh = look.next == 0 && !look.is_done;
  if (is_fresh || look.incarnation != incarnation) {
    look = {};
    look.incarnation = incarnation;
    look.taken = taken_by(reader.endpoint);
  }
  return look;
}

void WantedSources::go_on(Look & look, const OrphanReader & reader, Turn & turn) {
  EntryTable<SourceEntry> table =
    source_table(registry_.clusters().at(reader.endpoint.cluster), reader.subscription);
  look.is_done = true;
  const uint32_t first = look.next;
  table.visit(first, [&](SourceEntry & source, uint32_t index) {
    if (turn.is_over() && index != first) {  // it gets on, however much a turn has on it
      look.is_done = false;
      return true;
    }
    look.next = index + 1;
    turn.spend(steps_of_a_source);
    TopicDsmHeader * const dsm =
      source.state.load() == SourceState::active ? topic_dsm_of(registry_, source) : nullptr;
    if (dsm != nullptr) {
      const Cluster & cluster =
        registry_.clusters().at(SegmentRef{source.topic_dsm.load()}.cluster());
      turn.spend(closing::records_to_look_at(*dsm, source) / Turn::records_in_a_step);
      closing::list_undelivered(cluster, *dsm, source, index, look.newest);
    }
    if (look.newest.size() / 2 > reader.subscription.depth) {
      cut(look.newest, reader.subscription.depth);
    }
    return false;
  });
  if (look.is_done) {
    cut(look.newest, reader.subscription.depth);
    for (const Undelivered & record : look.newest) {
      look.sources.insert(record.source);
    }
    look.newest = {};
  }
}

/// A subscription that took something since the look began may want more than the look found. It
/// takes by itself what it wants, so it is given the time.
std::optional<bool> WantedSources::contain(const OrphanReader & reader, Turn & turn) {
  turn.spend(closing::records_to_look_at(reader.dsm, reader.source) / Turn::records_in_a_step);
  if (!closing::has_undelivered(reader)) {
    return false;
  }
  if (!is_cut_by_depth(reader)) {
    return true;
  }
  Look & look = look_of(reader);
  if (!look.is_done) {
    go_on(look, reader, turn);
  }
  if (!look.is_done) {
    return std::nullopt;
  }
  return look.taken != taken_by(reader.endpoint) || look.sources.count(reader.source_index) != 0;
}

}  // namespace manycore::sweeping
