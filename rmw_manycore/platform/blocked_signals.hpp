// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include <csignal>

namespace manycore {

/// Blocks all signals during its lifetime: a thread started meanwhile receives none, so signals are
/// handled by the program's own threads.
class BlockedSignals {
public:
  BlockedSignals() noexcept {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals &) = delete;
  BlockedSignals & operator=(const BlockedSignals &) = delete;

private:
  sigset_t before_;
};

}  // namespace manycore
