// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/peers/peers.hpp"

#include <algorithm>

#include "transport/registry/snapshot.hpp"

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
  const bool has_died = entry.died.load(std::memory_order_acquire) != 0;
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
    const EndpointEntry & entry = registry_.endpoints()[slot];
    const uint32_t order = entry.order;
    if (entry.slot.incarnation.load(std::memory_order_acquire) != incarnation) {
      return true;  // it has left: `order` is another one's
    }
    if (is_known(order)) {
      return false;
    }
    if (is_first || static_cast<int32_t>(order - newest) > 0) {
      newest = order;
    }
    is_first = false;
    consider(slot, incarnation);
    return true;
  });
  peers_.reserve(peers_.size() + found_.size());
  peers_.insert(peers_.end(), found_.rbegin(), found_.rend());
  counts_ = found_counts_;
  has_walked_ = has_walked_ || !is_first;
  newest_order_ = newest;
}

void Peers::consider(uint32_t slot, uint32_t incarnation) {
  const EntryCopy<EndpointEntry> copy(registry_.endpoints(), slot);
  const EndpointEntry & entry = *copy;
  const bool is_there =
    of_ == Of::live ? copy.state() == SlotState::live : has_memory(copy.state());
  if (!is_there || copy.incarnation() != incarnation || !copy.is_whole()) {
    return;  // it has left
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
      found_counts_.last_policy = fit.policy;
      return;
    case Fit::Kind::matched:
      ++found_counts_.matched_total;
      found_counts_.died -= found_counts_.died == 0 ? 0 : 1;
      found_.push_back(
        {slot, incarnation, entry.process.load(std::memory_order_relaxed), entry.block, entry.gid,
         entry.qos.reliability, entry.qos.durability, entry.qos.liveliness});
  }
}

}  // namespace manycore
