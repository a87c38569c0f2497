// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <vector>

#include "transport/topic_dsm/source.hpp"

namespace manycore {

/// Records found by a resync, oldest first; taken before those of the queue. Used by one thread at
/// a time (the subscription's mutex), except size().
class Backlog {
public:
  bool empty() const noexcept { return records_.empty(); }
  /// Callable from any thread: the queue's state is read without the mutex. seq_cst, because a
  /// thread that finds it empty sleeps (see Watchers).
  size_t size() const noexcept { return size_.load(std::memory_order_seq_cst); }

  void append(const std::vector<Source::Waiting> & records) {
    records_.insert(records_.end(), records.begin(), records.end());
    note_size();
  }
  const Source::Waiting & oldest() const noexcept { return records_.front(); }
  void pop_oldest() noexcept {
    records_.pop_front();
    note_size();
  }

private:
  void note_size() noexcept { size_.store(records_.size(), std::memory_order_seq_cst); }

  std::deque<Source::Waiting> records_;
  std::atomic<size_t> size_{0};
};

}  // namespace manycore
