// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "transport/topic_dsm/block_ring.hpp"

namespace manycore {

/// A publisher's private lists of its chunks. A Block is a chunk here: offsets in the cluster
/// segment, and its record's number.
class ChunkPool {
public:
  enum class State {
    wanted,  ///< readers are owed the record
    read,    ///< a reader claims or holds it, none is owed it
    unused,
  };

  /// SMEM of all chunks.
  uint64_t bytes() const noexcept { return bytes_; }
  /// Chunks with a record.
  uint64_t in_use() const noexcept { return used_.size() + kept_.size(); }
  size_t unused() const noexcept { return unused_.size(); }
  uint64_t kept_bytes() const noexcept {
    uint64_t sum = 0;
    for (const Block & chunk : kept_) {
      sum += chunk.end - chunk.begin;
    }
    return sum;
  }

  /// Finds the chunks that are unused by now, by `state_of(const Block &)`. Looks at the
  /// records in order, up to the first that is wanted: readers take them in this order.
  template<typename StateOf>
  void collect(StateOf state_of) {
    for (size_t i = 0; i < kept_.size();) {
      if (state_of(kept_[i]) == State::unused) {
        put_back(kept_[i]);
        kept_[i] = kept_.back();
        kept_.pop_back();
      } else {
        ++i;
      }
    }
    while (!used_.empty()) {
      const State state = state_of(used_.front());
      if (state == State::wanted) {
        return;
      }
      (state == State::read ? kept_ : unused_).push_back(used_.front());
      used_.pop_front();
    }
  }

  /// The oldest record that is wanted; collect() has just looked.
  const Block * oldest_wanted() noexcept { return used_.empty() ? nullptr : &used_.front(); }

  /// For one more chunk in any list: what follows cannot fail then.
  void make_room() {
    for (std::vector<Block> * list : {&kept_, &unused_, &unbacked_}) {
      list->reserve(count_ + 1);
    }
  }
  void add(const Block & chunk) noexcept { add_to(unused_, chunk); }
  /// A chunk whose SMEM could not be backed: it is the first one to be freed.
  void add_unbacked(const Block & chunk) noexcept { add_to(unbacked_, chunk); }
  /// An unused chunk of at least `bytes`, the smallest one, unless much of it would be left over.
  /// Of several, the one used last: the others fall out of use.
  std::optional<Block> take(uint64_t bytes) noexcept {
    const Block * best = nullptr;
    for (const Block & chunk : unused_) {
      const uint64_t length = chunk.end - chunk.begin;
      if (
        length >= bytes && length <= 2 * bytes &&
        (best == nullptr || length <= best->end - best->begin)) {
        best = &chunk;
      }
    }
    return best == nullptr ? std::nullopt : std::optional(take_out(unused_, best));
  }
  /// A chunk to free: one that is not backed, or was not used while the last `records` were
  /// published.
  const Block * idle(uint64_t newest, uint64_t records) const noexcept {
    if (!unbacked_.empty()) {
      return &unbacked_.back();
    }
    const auto found = std::find_if(unused_.begin(), unused_.end(), [&](const Block & chunk) {
      return chunk.number + records <= newest;
    });
    return found == unused_.end() ? nullptr : &*found;
  }
  /// One that idle() has returned, and that is freed.
  void remove(const Block & idle) noexcept {
    --count_;
    bytes_ -= idle.end - idle.begin;
    take_out(unbacked_.empty() ? unused_ : unbacked_, &idle);
  }

  /// The chunk has a record from now on.
  void use(const Block & chunk) { used_.push_back(chunk); }
  const Block & newest() noexcept { return used_.back(); }
  void put_back_newest() noexcept {
    put_back(used_.back());
    used_.pop_back();
  }
  void put_back(const Block & chunk) noexcept { unused_.push_back(chunk); }

private:
  void add_to(std::vector<Block> & list, const Block & chunk) noexcept {
    list.push_back(chunk);
    ++count_;
    bytes_ += chunk.end - chunk.begin;
  }
  static Block take_out(std::vector<Block> & list, const Block * chunk) noexcept {
    const Block taken = *chunk;
    list.erase(list.begin() + (chunk - list.data()));
    return taken;
  }

  BlockRing used_;             ///< by number
  std::vector<Block> kept_;    ///< not wanted, but read or held
  std::vector<Block> unused_;  ///< in the order of their last use
  std::vector<Block> unbacked_;
  uint64_t count_ = 0;  ///< of all chunks, lent ones included
  uint64_t bytes_ = 0;  ///< likewise
};

}  // namespace manycore
