// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/fork_side.hpp"

#include <pthread.h>

#include <atomic>

namespace manycore {
namespace {

std::atomic<uint32_t> forks{0};

/// Before main(): a fork that nothing of this library knows of has to be counted, too.
const int registered =
  pthread_atfork(nullptr, nullptr, [] { forks.fetch_add(1, std::memory_order_relaxed); });

}  // namespace

uint32_t ForkSide::forks_before() noexcept { return forks.load(std::memory_order_relaxed); }

}  // namespace manycore
