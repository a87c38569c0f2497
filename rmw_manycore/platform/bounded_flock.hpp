// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace manycore {

/// Locks a file exclusively, as flock() does, and then calls `act`, which must not throw. Sleeps in
/// the kernel's queue of the file for at most about `timeout_ms` in which this process can run;
/// returns false after that. The thread that waited calls `act`: on a loaded machine, a lock that
/// waits for another thread to use it keeps all others waiting. Throws std::system_error.
bool flock_within(int fd, int timeout_ms, const std::function<void()> & act = [] {});

}  // namespace manycore
