// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "platform/fork_side.hpp"
#include "transport/layout/chunk_layout.hpp"
#include "transport/layout/qos.hpp"

namespace manycore {

class Cluster;
class Registry;
struct Slot;

/// Number of records that a subscription's process holds for it. Outlives the subscription.
class HeldCount {
public:
  /// Beside a history: a program that keeps its messages makes the publisher's memory grow by this.
  static constexpr uint32_t beside_depth = 4;

  uint32_t count() const noexcept { return count_->load(std::memory_order_relaxed); }
  bool may_take(const Qos & qos) const noexcept {
    const uint32_t depth = qos.history == History::keep_all ? 0 : qos.depth;
    return count() < depth + beside_depth;
  }

private:
  friend class Hold;

  std::shared_ptr<std::atomic<uint32_t>> count_ = std::make_shared<std::atomic<uint32_t>>(0);
};

/// Keeps the bytes of a record in place after its claim has ended, and after its publisher and its
/// subscription have. Any thread may destroy it. It must not outlive the Process. In a child of
/// fork() the destructor has no effect. See docs/design/holds.md.
class Hold {
public:
  struct Bytes {
    const uint8_t * data;
    size_t size;
  };
  struct Holder {
    Registry & registry;
    const Cluster & cluster;  ///< of the topic DSM
    const Slot & publisher;
    uint32_t process;  ///< slot
  };

  /// False while SMEM is too scarce for holds: the publisher needs room for what is to come.
  static bool leaves_room(const Cluster & cluster, size_t bytes) noexcept;
  /// Called under a claim. Nothing if a hold would not leave room, or if the chunk has no room for
  /// a further holder.
  static std::optional<Hold> take(
    const Holder & holder, ChunkHead & chunk, const Bytes & bytes, bool is_for_one_reader,
    const HeldCount & count) noexcept;
  Hold(Hold && other) noexcept;
  Hold & operator=(Hold &&) = delete;
  ~Hold();

  /// In a child of fork(): false if the parent was found dead, so that the bytes may have changed.
  bool is_kept() const noexcept;
  /// No other subscription reads the bytes, ever: their holder may write into them.
  bool is_sole() const noexcept { return is_sole_; }
  /// The CDR. What follows its encapsulation of four bytes is aligned to 64.
  const uint8_t * data() const noexcept { return bytes_.data; }
  size_t size() const noexcept { return bytes_.size; }

private:
  Hold(
    const Holder & holder, std::atomic<uint64_t> & word, const Bytes & bytes, bool is_sole,
    std::shared_ptr<std::atomic<uint32_t>> count) noexcept;

  Registry & registry_;
  const Cluster & cluster_;
  const Slot & publisher_;
  std::atomic<uint64_t> * word_;  ///< nullptr after a move
  uint64_t own_;                  ///< what it holds
  Bytes bytes_;
  bool is_sole_;
  std::shared_ptr<std::atomic<uint32_t>> count_;
  ForkSide side_;
};

}  // namespace manycore
