// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/robust_mutex.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include "platform/clock.hpp"
#include "platform/error.hpp"

namespace manycore {

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
  switch (const int error = pthread_mutex_clocklock(&mutex_, CLOCK_MONOTONIC, &until)) {
    case 0:
      return Outcome::locked;
    case EOWNERDEAD:
      return Outcome::owner_died;
    case ETIMEDOUT:
      throw Error(
        ErrorCode::timeout,
        "the platform's registry stayed locked; is a process that was joining or leaving stopped?");
    default:
      throw Error(
        ErrorCode::corrupt, std::string("the registry's lock is damaged: ") + std::strerror(error));
  }
}

void RobustMutex::unlock() noexcept { pthread_mutex_unlock(&mutex_); }

void RobustMutex::mark_consistent() noexcept { pthread_mutex_consistent(&mutex_); }

}  // namespace manycore
