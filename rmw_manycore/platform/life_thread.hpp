// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <linux/futex.h>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "platform/futex.hpp"

namespace manycore {

/// A thread that does nothing but hold a futex word in shared memory: when it ends, for whatever
/// reason, the kernel clears its number in the word and sets FUTEX_OWNER_DIED. Its list of robust
/// futexes is its own, not that of the C library, so another thread can make it hold a word without
/// waking it.
class LifeThread {
public:
  /// Throws std::system_error. Returns once the thread has registered its list.
  LifeThread();
  /// Ends the thread, and so releases the word. Not in a child of fork(), which has no such thread.
  ~LifeThread();
  LifeThread(const LifeThread &) = delete;
  LifeThread & operator=(const LifeThread &) = delete;

  /// Makes the thread hold a word, once. The word is not held, and no other process tries to hold
  /// it; its memory stays mapped until the thread has ended.
  void hold(FutexWord & word) noexcept;

private:
  void run();

  robust_list_head head_{};
  robust_list entry_{};
  uint32_t number_ = 0;  ///< of the thread in its PID namespace; 0 until it has registered the list
  bool ends_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace manycore
