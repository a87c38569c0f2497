// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "stepped_child.hpp"

#include <sched.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

#include "waiting.hpp"

namespace {

constexpr int begin_signal = SIGUSR1;
constexpr int finish_signal = SIGUSR2;
constexpr int end_signal = SIGPROF;

void end_this_thread(int) { syscall(SYS_exit, 0); }

bool is_main_thread_dead(pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string number;
  std::string name;
  char state = 0;
  stat >> number >> name >> state;
  return state == 'Z';
}

cpu_set_t affinity() {
  cpu_set_t cpus;
  require(sched_getaffinity(0, sizeof cpus, &cpus) == 0);
  return cpus;
}

cpu_set_t only(int cpu) {
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<size_t>(cpu), &cpus);
  return cpus;
}

/// Signal that stopped a traced process.
int wait_for_stop(pid_t pid) {
  int status = 0;
  if (waitpid(pid, &status, 0) != pid || !WIFSTOPPED(status)) {
    throw std::runtime_error("a stepped process has ended");
  }
  return WSTOPSIG(status);
}

}  // namespace

void begin_steps() {
  signal(end_signal, end_this_thread);
  require(ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) == 0);
  raise(begin_signal);
}

void finish_steps() { raise(finish_signal); }

SteppedChild::SteppedChild(const std::string & role, const Arguments & arguments)
: Child(role, arguments), cpus_(affinity()) {
  const cpu_set_t one = only(sched_getcpu());
  require(sched_setaffinity(0, sizeof one, &one) == 0);
  require(sched_setaffinity(pid(), sizeof one, &one) == 0);
  if (wait_for_stop(pid()) != begin_signal) {
    throw std::runtime_error("a stepped process did not reach begin_steps()");
  }
}

SteppedChild::~SteppedChild() { sched_setaffinity(0, sizeof cpus_, &cpus_); }

uint64_t SteppedChild::step(uint64_t instructions) {
  uint64_t done = 0;
  while (done < instructions && !finished_) {
    resume(PTRACE_SINGLESTEP);
    ++done;
  }
  return done;
}

void SteppedChild::run_to_system_call() { resume(PTRACE_SYSCALL); }

void SteppedChild::resume(int request) {
  ptrace(static_cast<__ptrace_request>(request), pid(), nullptr, nullptr);
  const int stopped_by = wait_for_stop(pid());
  if (stopped_by == SIGBUS || stopped_by == SIGSEGV) {
    throw std::runtime_error("a stepped process has accessed memory that is not there");
  }
  finished_ = stopped_by == finish_signal;
}

void SteppedChild::end_main_thread() {
  ptrace(PTRACE_DETACH, pid(), nullptr, end_signal);
  wait_until("the main thread has ended", [this] { return is_main_thread_dead(pid()); });
}
