// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <semaphore.h>

namespace manycore {

/// A mutex of one process that any thread may unlock, not only the one that locked it. Not
/// recursive. std::mutex leaves that undefined, and C++17 has no std::binary_semaphore.
class HandoverMutex {
public:
  HandoverMutex() noexcept { sem_init(&free_, 0, 1); }
  ~HandoverMutex() { sem_destroy(&free_); }
  HandoverMutex(const HandoverMutex &) = delete;
  HandoverMutex & operator=(const HandoverMutex &) = delete;

  void lock() noexcept {
    while (sem_wait(&free_) != 0) {  // a signal handler ran
    }
  }
  void unlock() noexcept { sem_post(&free_); }

private:
  sem_t free_;
};

}  // namespace manycore
