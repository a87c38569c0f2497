// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/borrowing/adopted.hpp"

namespace rmw_manycore {

Adopted & Adopted::messages() {
  static Adopted & adopted = *new Adopted;  // never destroyed: Python may still use it at exit
  return adopted;
}

void Adopted::add(const void * message, bool is_read_only) {
  const std::lock_guard<std::mutex> lock(mutex_);
  messages_[message] = {is_read_only, {}};
  count_.store(messages_.size(), std::memory_order_relaxed);
}

void Adopted::remove(const void * message) noexcept {
  decltype(messages_)::node_type removed;  // gives back its record without the mutex
  const std::lock_guard<std::mutex> lock(mutex_);
  removed = messages_.extract(message);
  count_.store(messages_.size(), std::memory_order_relaxed);
}

/// Relaxed: a message is handed from thread to thread in a way that orders memory.
AdoptedMessage * Adopted::find(const void * message) noexcept {
  if (count_.load(std::memory_order_relaxed) == 0) {
    return nullptr;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = messages_.find(message);
  return found == messages_.end() ? nullptr : &found->second;
}

}  // namespace rmw_manycore
