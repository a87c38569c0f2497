// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>

#include <new>
#include <optional>

#include "transport/queue/subscriber_queue.hpp"

/// A subscriber queue without a platform, in memory shared only with later forks.
class BareQueue {
public:
  BareQueue(uint32_t depth, bool keep_all) {
    uint32_t log2 = 0;
    while ((1u << log2) < depth) {
      ++log2;
    }
    void * const memory =
      mmap(nullptr, segment_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    header_ = new (memory) manycore::SubscriptionHeader{};
    header_->depth = depth;
    header_->slot_count_log2 = log2;
    header_->keep_all = keep_all ? 1 : 0;
    manycore::subscriber_queue::initialize(*header_);
  }
  ~BareQueue() { munmap(header_, segment_bytes); }
  BareQueue(const BareQueue &) = delete;
  BareQueue & operator=(const BareQueue &) = delete;

  manycore::SubscriptionHeader & header() noexcept { return *header_; }
  void push(const manycore::Hint & hint) noexcept {
    manycore::subscriber_queue::push(*header_, hint);
  }
  std::optional<manycore::Hint> pop() noexcept { return manycore::subscriber_queue::pop(*header_); }
  uint64_t displaced() const noexcept { return header_->displaced().hints; }
  bool empty() noexcept { return manycore::subscriber_queue::empty(*header_); }

private:
  static constexpr size_t segment_bytes = 1 << 20;
  manycore::SubscriptionHeader * header_;
};
