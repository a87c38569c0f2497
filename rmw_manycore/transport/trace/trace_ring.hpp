// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "transport/layout/trace_layout.hpp"

namespace manycore {

/// The writing role of one ring; one thread. Publish by counter: an event is filled in, then
/// `written` is raised (release), so the saver that loads it (acquire) finds the event whole. A
/// place is filled again only after `read` (acquire) says that the saver is done with it. Never
/// waits: without room the event is counted as lost.
class TraceRingWriter {
public:
  TraceRingWriter(TraceRing & ring, TraceEvent * events, uint32_t events_log2) noexcept
  : ring_(&ring),
    events_(events),
    capacity_(uint64_t{1} << events_log2),
    written_(ring.written.load(std::memory_order_relaxed)),
    read_(ring.read.load(std::memory_order_acquire)) {}

  /// `back(first)` makes memory for events from `first` on, and returns how many have some then.
  template<typename Back>
  void push(const TraceEvent & event, Back back) noexcept {
    if (!try_push(event, back)) {
      ring_->lost.store(ring_->lost.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
  }
  /// False where there is no room; not counted as lost.
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
  uint64_t read_;  ///< as seen last
};

}  // namespace manycore
