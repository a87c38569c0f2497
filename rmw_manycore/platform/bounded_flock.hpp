// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace manycore {

/// Locks a file exclusively, as flock() does. Sleeps in the kernel's queue of the file for at most
/// about `timeout_ms` in which this process can run; returns false after that. Throws
/// std::system_error.
bool flock_within(int fd, int timeout_ms);

}  // namespace manycore
