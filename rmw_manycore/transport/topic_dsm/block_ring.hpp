// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace manycore {

/// Bytes of a data area that hold a record, or held one that a reader still has pinned.
struct Block {
  uint64_t begin;
  uint64_t end;
  uint64_t number;
};

/// A publisher's private list of blocks, in the order in which its cursor meets them. The storage
/// grows and never shrinks, so the steady state allocates nothing.
class BlockRing {
public:
  BlockRing() : slots_(64) {}

  bool empty() const noexcept { return count_ == 0; }
  size_t size() const noexcept { return count_; }
  uint64_t bytes() const noexcept { return bytes_; }
  Block & front() noexcept { return slots_[first_]; }
  Block & back() noexcept { return slots_[(first_ + count_ - 1) % slots_.size()]; }

  void push_back(const Block & block) {
    if (count_ == slots_.size()) {
      std::rotate(slots_.begin(), slots_.begin() + static_cast<ptrdiff_t>(first_), slots_.end());
      first_ = 0;
      slots_.resize(slots_.size() * 2);
    }
    slots_[(first_ + count_++) % slots_.size()] = block;
    bytes_ += block.end - block.begin;
  }
  void pop_front() noexcept {
    bytes_ -= front().end - front().begin;
    first_ = (first_ + 1) % slots_.size();
    --count_;
  }
  void pop_back() noexcept {
    bytes_ -= back().end - back().begin;
    --count_;
  }
  /// Reduces the last block to the bytes that its record used.
  void shrink_back(uint64_t end) noexcept {
    bytes_ -= back().end - end;
    back().end = end;
  }
  void clear() noexcept { count_ = bytes_ = 0; }

private:
  std::vector<Block> slots_;
  size_t first_ = 0;
  size_t count_ = 0;
  uint64_t bytes_ = 0;
};

}  // namespace manycore
