// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>

namespace manycore {

/// Describes the owner of a lock from /proc, and what to do about it. `thread` is 0 for a lock
/// without an owner at this moment.
std::string describe_lock_owner(pid_t thread);

/// True if the owner of a lock may still release it: it runs, sleeps or waits for a CPU, or
/// `thread` is 0. False if it is stopped or not visible here.
bool may_unlock(pid_t thread);

/// As describe_lock_owner(), for a file that another process has locked with flock().
std::string describe_flock_owner(int fd);

}  // namespace manycore
