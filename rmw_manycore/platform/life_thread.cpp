// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/life_thread.hpp"

#include <pthread.h>

#include "platform/blocked_signals.hpp"

namespace manycore {

LifeThread::LifeThread() {
  head_.list.next = &head_.list;
  {
    const BlockedSignals blocked;
    thread_ = std::thread([this] { run(); });
  }
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return number_ != 0; });
}

LifeThread::~LifeThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void LifeThread::run() {
  pthread_setname_np(pthread_self(), "manycore_life");
  // Replaces the list of the C library: this thread locks no robust mutex of it.
  syscall(SYS_set_robust_list, &head_, sizeof head_);
  std::unique_lock<std::mutex> lock(mutex_);
  number_ = static_cast<uint32_t>(gettid());
  changed_.notify_one();
  changed_.wait(lock, [this] { return ends_; });
}

/// The word is listed before it holds the number: a thread that ends in between finds another
/// number there, and leaves it alone.
void LifeThread::hold(FutexWord & word) noexcept {
  head_.futex_offset = reinterpret_cast<char *>(&word) - reinterpret_cast<char *>(&entry_);
  entry_.next = &head_.list;
  std::atomic_thread_fence(std::memory_order_release);
  head_.list.next = &entry_;
  std::atomic_thread_fence(std::memory_order_seq_cst);
  word.store(number_);
}

}  // namespace manycore
