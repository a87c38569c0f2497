// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/fork_side.hpp"

#include <pthread.h>

namespace manycore {

std::atomic<uint32_t> ForkSide::forks{0};

/// Registered before main(), so that forks by other libraries are counted as well.
const int ForkSide::registered = pthread_atfork(nullptr, nullptr, [] { count_fork(); });

}  // namespace manycore
