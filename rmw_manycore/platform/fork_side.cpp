// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/fork_side.hpp"

#include <pthread.h>

namespace manycore {

std::atomic<uint32_t> ForkSide::forks{0};

/// Before main(): a fork that nothing of this library knows of has to be counted, too.
const int ForkSide::registered = pthread_atfork(nullptr, nullptr, [] { count_fork(); });

}  // namespace manycore
