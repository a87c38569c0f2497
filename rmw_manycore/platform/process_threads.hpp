// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

#include "platform/file_descriptor.hpp"

namespace manycore {

/// The threads of another process of this user, as proc(5) shows them.
class ProcessThreads {
public:
  /// Of a thread, until it ends: one that gets the same id later has others.
  struct Files {
    FileDescriptor call;   ///< system call that it is in
    FileDescriptor turns;  ///< times that it was given a CPU
  };

  explicit ProcessThreads(pid_t pid);

  /// What a look found.
  struct Look {
    bool asleep = true;
    pid_t tid = 0;      ///< a thread that is awake, if one is
    std::string doing;  ///< and the system call that it is in; empty: it computes
  };

  /// Whether all threads but `blocked` slept at one moment, until another thread wakes them or
  /// something arrives from outside. Threads of `strict` must not even wait with a timeout.
  ///
  /// Looks twice: a thread looked at first may be woken by one that sleeps by the time that it is
  /// looked at. Had any run in between, its count of turns on a CPU would differ.
  Look look(const std::vector<pid_t> & blocked, const std::vector<pid_t> & strict);

private:
  void list_again();
  /// Appends what the threads do to `seen`.
  Look look_once(
    const std::vector<pid_t> & blocked, const std::vector<pid_t> & strict, std::string & seen);

  const std::string directory_;
  uint64_t count_ = 0;
  std::map<pid_t, Files> threads_;
};

}  // namespace manycore
