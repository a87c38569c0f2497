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
    read,    ///< or hold it: nobody waits for it, but its bytes stay
    unused,
  };

  /// SMEM of all chunks.
  uint64_t bytes() const noexcept { return bytes_; }
  /// Chunks with a record.
  uint64_t in_use() const noexcept { return used_.size() + kept_.size(); }
  uint64_t kept_bytes() const noexcept {
    uint64_t sum = 0;
    for (const Block & chunk : kept_) {
      sum += chunk.end - chunk.begin;
    }
    return sum;
  }

  /// Finds the chunks that are unused by now: `state_of(const Block &)` says which. Looks at the
  /// records in order, up to the first that is wanted: readers take them in this order.
  template<typename StateOf>
  void collect(StateOf state_of) {
    for (size_t i = 0; i < kept_.size();) {
      if (state_of(kept_[i]) == State::read) {
        ++i;
        continue;
      }
      put_back(kept_[i]);
      kept_[i] = kept_.back();
      kept_.pop_back();
    }
    while (!used_.empty()) {
      const State state = state_of(used_.front());
      if (state == State::wanted) {
        return;
      }
      reserve(kept_);
      if (state == State::read) {
        kept_.push_back(used_.front());
      } else {
        put_back(used_.front());
      }
      used_.pop_front();
    }
  }

  /// The oldest record that is wanted; collect() has just looked.
  const Block * oldest_wanted() noexcept { return used_.empty() ? nullptr : &used_.front(); }

  void add(const Block & chunk) {
    reserve(unused_);
    put_back(chunk);
    ++count_;
    bytes_ += chunk.end - chunk.begin;
  }
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
    return best == nullptr ? std::nullopt : std::optional(remove(*best));
  }
  /// An unused chunk that was not used while the last `records` were published, or any.
  std::optional<Block> take_idle(uint64_t newest, uint64_t records) noexcept {
    for (const Block & chunk : unused_) {
      if (chunk.number + records <= newest) {
        return remove(chunk);
      }
    }
    return std::nullopt;
  }
  void forget(const Block & chunk) noexcept {
    --count_;
    bytes_ -= chunk.end - chunk.begin;
  }

  /// The chunk has a record from now on.
  void use(const Block & chunk) {
    reserve(unused_);  // for put_back(), which must not fail
    used_.push_back(chunk);
  }
  const Block & newest() noexcept { return used_.back(); }
  void put_back_newest() noexcept {
    put_back(used_.back());
    used_.pop_back();
  }
  void put_back(const Block & chunk) noexcept { unused_.push_back(chunk); }

private:
  /// Room for all chunks, so that none is lost for want of memory.
  void reserve(std::vector<Block> & list) { list.reserve(count_ + 1); }
  Block remove(const Block & chunk) noexcept {
    const Block taken = chunk;
    unused_.erase(unused_.begin() + (&chunk - unused_.data()));
    return taken;
  }

  BlockRing used_;             ///< by number
  std::vector<Block> kept_;    ///< not wanted, but read or held
  std::vector<Block> unused_;  ///< in the order of their last use
  uint64_t count_ = 0;         ///< of all chunks, lent ones included
  uint64_t bytes_ = 0;         ///< likewise
};

}  // namespace manycore
