// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/trace_layout.hpp"

namespace manycore {

/// Writing side of one ring; used by one thread. An event is filled in before `written` is
/// incremented (release), so a saver that loads `written` (acquire) finds the event complete. Space
/// is reused only after `read` (acquire) shows that the saver has copied it. Never blocks: an event
/// without room is counted as lost.
class TraceRingWriter {
public:
  TraceRingWriter(TraceRing & ring, TraceEvent * events, uint32_t events_log2) noexcept
  : ring_(&ring),
    events_(events),
    capacity_(uint64_t{1} << events_log2),
    written_(ring.written.load(std::memory_order_relaxed)),
    read_(ring.read.load(std::memory_order_acquire)) {}

  /// Calls `back(first)` to back events from index `first` on; it returns how many are backed then.
  template<typename Back>
  void push(const TraceEvent & event, Back back) noexcept {
    if (!try_push(event, back)) {
      ring_->lost.store(ring_->lost.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
  }
  /// As push(), but returns false instead of counting a lost event.
  template<typename Back>
  bool try_push(const TraceEvent & event, Back back) noexcept {
    if (written_ - read_ >= capacity_) {
      read_ = ring_->read.load(std::memory_order_acquire);
    }
    if (written_ - read_ >= capacity_ || (written_ >= ring_->backed && !grow(back))) {
      return false;
    }
    events_[written_ & (capacity_ - 1)] = event;
    ring_->written.store(++written_, std::memory_order_release);
    return true;
  }

  TraceRing & ring() const noexcept { return *ring_; }

private:
  template<typename Back>
  bool grow(Back back) noexcept {
    if (ring_->backed < capacity_) {
      ring_->backed = back(ring_->backed);
    }
    return written_ < ring_->backed || ring_->backed >= capacity_;
  }

  TraceRing * ring_;
  TraceEvent * events_;
  uint64_t capacity_;
  uint64_t written_;
  uint64_t read_;  ///< last value loaded
};

}  // namespace manycore
