// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "stepped_child.hpp"

#include <sys/ptrace.h>
#include <sys/wait.h>

#include <csignal>
#include <stdexcept>

namespace {

constexpr int begin_signal = SIGUSR1;
constexpr int finish_signal = SIGUSR2;

/// The signal that stopped a traced process.
int wait_for_stop(pid_t pid) {
  int status = 0;
  if (waitpid(pid, &status, 0) != pid || !WIFSTOPPED(status)) {
    throw std::runtime_error("a stepped process has ended by itself");
  }
  return WSTOPSIG(status);
}

}  // namespace

void begin_steps() {
  require(ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0);
  raise(begin_signal);
}

void finish_steps() { raise(finish_signal); }

SteppedChild::SteppedChild(const std::string & role, const Arguments & arguments)
: Child(role, arguments) {
  if (wait_for_stop(pid()) != begin_signal) {
    throw std::runtime_error("a stepped process has not come to its steps");
  }
}

uint64_t SteppedChild::step(uint64_t instructions) {
  uint64_t done = 0;
  while (done < instructions && !finished_) {
    ptrace(PTRACE_SINGLESTEP, pid(), nullptr, nullptr);
    finished_ = wait_for_stop(pid()) == finish_signal;
    ++done;
  }
  return done;
}
