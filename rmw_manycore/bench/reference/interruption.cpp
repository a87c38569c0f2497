// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/reference/interruption.hpp"

#include <pthread.h>

#include <atomic>
#include <csignal>

namespace manycore::bench::reference {

namespace {

std::atomic<bool> interrupted = false;

sigset_t interruptions() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

}  // namespace

void block_interruptions() {
  const sigset_t signals = interruptions();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

bool is_interrupted() { return interrupted; }

Interruption::Interruption(RclContext & context) : guard_condition_(context) {
  waiter_ = std::thread([this] {
    const sigset_t signals = interruptions();
    int signal = 0;
    sigwait(&signals, &signal);
    interrupted = true;
    guard_condition_.trigger();
  });
}

Interruption::~Interruption() {
  if (!interrupted) {
    pthread_kill(waiter_.native_handle(), SIGTERM);
  }
  waiter_.join();
}

}  // namespace manycore::bench::reference
