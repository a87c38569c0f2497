// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <string>

namespace manycore {

/// What /proc says about the thread that a lock names as its owner, and what to do about it.
/// `thread`: 0 for a lock that no thread owns at this moment.
std::string describe_lock_owner(pid_t thread);

/// True when the owner of a lock may come to give it back: it runs, sleeps or waits for a CPU, or
/// `thread` is 0. False for one that is stopped, or not visible here.
bool may_unlock(pid_t thread);

/// As describe_lock_owner(), of an open file that another process has locked with flock().
std::string describe_flock_owner(int fd);

}  // namespace manycore
