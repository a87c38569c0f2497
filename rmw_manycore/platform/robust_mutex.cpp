// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/robust_mutex.hpp"

#include <linux/futex.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "platform/clock.hpp"
#include "platform/error.hpp"

#if defined(__has_feature)
#define MANYCORE_THREAD_SANITIZER __has_feature(thread_sanitizer)
#elif defined(__SANITIZE_THREAD__)
#define MANYCORE_THREAD_SANITIZER 1
#else
#define MANYCORE_THREAD_SANITIZER 0
#endif
#if MANYCORE_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace manycore {
namespace {

int lock_until(pthread_mutex_t & mutex, const timespec & until) {
#if MANYCORE_THREAD_SANITIZER
  // The thread sanitizers of gcc 12 and clang 14 intercept pthread_mutex_unlock, but not
  // pthread_mutex_clocklock.
  __tsan_mutex_pre_lock(&mutex, 0);
  const int error = pthread_mutex_clocklock(&mutex, CLOCK_MONOTONIC, &until);
  const bool locked = error == 0 || error == EOWNERDEAD;
  __tsan_mutex_post_lock(
    &mutex, locked ? 0 : __tsan_mutex_try_lock | __tsan_mutex_try_lock_failed, 0);
  return error;
#else
  return pthread_mutex_clocklock(&mutex, CLOCK_MONOTONIC, &until);
#endif
}

/// Futex word of a robust mutex: thread id of the owner, which the kernel clears when the thread
/// ends, and a flag that threads wait.
uint32_t futex_word_of(const pthread_mutex_t & mutex) {
  return static_cast<uint32_t>(__atomic_load_n(&mutex.__data.__lock, __ATOMIC_ACQUIRE));
}

}  // namespace

void RobustMutex::initialize() {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  pthread_mutexattr_setpshared(&attributes, PTHREAD_PROCESS_SHARED);
  pthread_mutexattr_setrobust(&attributes, PTHREAD_MUTEX_ROBUST);
  const int error = pthread_mutex_init(&mutex_, &attributes);
  pthread_mutexattr_destroy(&attributes);
  if (error != 0) {
    throw Error(ErrorCode::system, std::string("cannot create a mutex: ") + std::strerror(error));
  }
}

RobustMutex::Outcome RobustMutex::lock(long timeout_ns) {
  const timespec until = to_timespec(monotonic_ns() + timeout_ns);
  switch (const int error = lock_until(mutex_, until)) {
    case 0:
      return Outcome::locked;
    case EOWNERDEAD:
      return Outcome::owner_died;
    case ETIMEDOUT:
      return Outcome::timed_out;
    default:
      throw Error(
        ErrorCode::corrupt, std::string("a robust mutex is damaged: ") + std::strerror(error));
  }
}

pid_t RobustMutex::owner() const noexcept {
  return static_cast<pid_t>(futex_word_of(mutex_) & FUTEX_TID_MASK);
}

bool RobustMutex::is_waited_for() const noexcept {
  return (futex_word_of(mutex_) & FUTEX_WAITERS) != 0;
}

void RobustMutex::unlock() noexcept { pthread_mutex_unlock(&mutex_); }

void RobustMutex::mark_owner_died(pid_t thread) noexcept {
  int seen = mutex_.__data.__lock;
  const auto owner = static_cast<pid_t>(static_cast<uint32_t>(seen) & FUTEX_TID_MASK);
  if (thread != 0 && owner == thread) {
    __atomic_compare_exchange_n(
      &mutex_.__data.__lock, &seen, static_cast<int>(FUTEX_OWNER_DIED), false, __ATOMIC_ACQ_REL,
      __ATOMIC_RELAXED);
  }
}

void RobustMutex::mark_consistent() noexcept { pthread_mutex_consistent(&mutex_); }

}  // namespace manycore
