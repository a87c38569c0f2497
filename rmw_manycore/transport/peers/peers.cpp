// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/peers/peers.hpp"

#include <algorithm>

namespace manycore {

Peers::Peers(Registry & registry, const EndpointEntry & own, Of of)
: registry_(registry), own_(own), of_(of) {}

/// `changes` is loaded before the rows: a row that changes meanwhile is looked at once more.
bool Peers::refresh() {
  const uint64_t changes = registry_.changes_of(own_.topic_hash);
  if (has_looked_ && changes == seen_changes_) {
    return false;
  }
  drop_gone();
  find_new();
  seen_changes_ = changes;
  has_looked_ = true;
  return true;
}

/// How an endpoint ended is stored before its state, and its slot's incarnation is raised before
/// either is changed again.
Peers::Presence Peers::presence_of(const Peer & peer) const noexcept {
  const EndpointEntry & entry = registry_.endpoints()[peer.slot];
  const SlotState state = entry.slot.state.load(std::memory_order_acquire);
  const bool was_alive = peer.liveliness == Liveliness::automatic || entry.asserted_ns.load() != 0;
  const bool has_died = entry.died.load(std::memory_order_acquire) != 0 && was_alive;
  std::atomic_thread_fence(std::memory_order_acquire);
  if (entry.slot.incarnation.load(std::memory_order_relaxed) != peer.incarnation) {
    return Presence::left;
  }
  const bool is_there = of_ == Of::live ? state == SlotState::live : has_memory(state);
  return is_there ? Presence::there : has_died ? Presence::died : Presence::left;
}

void Peers::drop_gone() noexcept {
  const auto gone = std::remove_if(peers_.begin(), peers_.end(), [this](const Peer & peer) {
    const Presence presence = presence_of(peer);
    counts_.died += presence == Presence::died ? 1 : 0;
    return presence != Presence::there;
  });
  peers_.erase(gone, peers_.end());
}

/// Later endpoints have larger numbers, which wrap around.
bool Peers::is_known(uint32_t order) const noexcept {
  return has_walked_ && static_cast<int32_t>(order - newest_order_) <= 0;
}

/// Nothing is kept of a walk that throws.
void Peers::find_new() {
  found_.clear();
  found_counts_ = counts_;
  bool is_first = true;
  uint32_t newest = newest_order_;
  registry_.walk_bucket(own_.topic_hash, [&](uint32_t slot, uint32_t incarnation) {
    const EntryCopy<EndpointEntry> row(registry_.endpoints(), slot);
    if (row.incarnation() != incarnation || !row.is_whole()) {
      return true;  // it has left
    }
    const uint32_t order = (*row).order;
    if (is_known(order)) {
      return false;
    }
    if (is_first || static_cast<int32_t>(order - newest) > 0) {
      newest = order;
    }
    is_first = false;
    consider(slot, row);
    return true;
  });
  peers_.reserve(peers_.size() + found_.size());
  peers_.insert(peers_.end(), found_.rbegin(), found_.rend());
  counts_ = found_counts_;
  has_walked_ = has_walked_ || !is_first;
  newest_order_ = newest;
}

void Peers::consider(uint32_t slot, const EntryCopy<EndpointEntry> & row) {
  const EndpointEntry & entry = *row;
  const bool is_there = of_ == Of::live ? row.state() == SlotState::live : has_memory(row.state());
  if (!is_there) {
    return;
  }
  const Fit fit = fit_of(own_, entry);
  switch (fit.kind) {
    case Fit::Kind::strangers:
      return;
    case Fit::Kind::other_type:
      ++found_counts_.incompatible_types;
      return;
    case Fit::Kind::other_qos:
      ++found_counts_.incompatible_qos;
      if (found_counts_.incompatible_qos == counts_.incompatible_qos + 1) {
        found_counts_.last_policy = fit.policy;  // the youngest one's
      }
      return;
    case Fit::Kind::matched:
      ++found_counts_.matched_total;
      found_counts_.died -= found_counts_.died == 0 ? 0 : 1;
      found_.push_back(
        {slot, row.incarnation(), entry.process.load(std::memory_order_relaxed), entry.block,
         entry.gid, entry.qos.reliability, entry.qos.durability, entry.qos.liveliness});
  }
}

}  // namespace manycore
