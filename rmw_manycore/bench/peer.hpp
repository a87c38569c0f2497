// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <system_error>

#include "platform/futex.hpp"

/// Building blocks of the peers: system calls only, without any middleware.
namespace manycore::bench {

inline void pin_to(size_t cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) != 0) {
    throw std::system_error(errno, std::generic_category(), "sched_setaffinity");
  }
}

/// Zeroed memory, faulted in, shared with children of this process.
inline std::byte * shared_memory(size_t bytes) {
  void * memory =
    mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
  if (memory == MAP_FAILED) {
    throw std::system_error(errno, std::generic_category(), "mmap");
  }
  return static_cast<std::byte *>(memory);
}

/// Buffer for one message at a time, with one writer and one reader.
struct alignas(64) Slot {
  FutexWord written{0};

  std::byte * payload() { return reinterpret_cast<std::byte *>(this + 1); }

  static Slot & create(size_t payload_bytes) {
    return *new (shared_memory(sizeof(Slot) + payload_bytes)) Slot;
  }
  /// Sleeps until message `number`, counted from 1, is announced.
  void wait_for(uint32_t number) {
    for (uint32_t seen = written.load(); seen != number; seen = written.load()) {
      futex_wait(written, seen, std::nullopt);
    }
  }
  void announce(uint32_t number) {
    written.store(number);
    futex_wake_all(written);
  }
};

/// Runs `body` in a child process on `cpu`. The child ends after it, or when its parent dies.
template<typename Body>
pid_t fork_on(size_t cpu, Body body) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child != 0) {
    return child;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {  // the parent died before prctl()
    _exit(EXIT_FAILURE);
  }
  pin_to(cpu);
  body();
  _exit(EXIT_SUCCESS);
}

/// Returns when all children have ended.
inline void wait_for_children() {
  while (wait(nullptr) > 0) {
  }
}

}  // namespace manycore::bench
