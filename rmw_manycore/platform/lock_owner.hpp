// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace manycore {

/// The thread that owns a lock, or waits to release it.
struct LockOwner {
  pid_t thread = 0;            ///< in its PID namespace; 0 = none at this moment
  uint64_t pid_namespace = 0;  ///< as in ProcessIdentity
};

/// Describes the owner of a lock from /proc, and what to do about it.
std::string describe_lock_owner(const LockOwner & owner);

/// As describe_lock_owner(), for a file that another process has locked with flock().
std::string describe_flock_owner(int fd);

/// Watches the owner of a lock between two attempts to take it.
class LockOwnerWatch {
public:
  /// True if the owner may still release the lock: it runs, waits for a CPU or a disk, has run
  /// since the last look, or there is no owner. False if it is stopped, frozen (cgroup), or in
  /// another PID namespace. The first look at a sleeping owner is true.
  bool may_unlock(const LockOwner & owner);

private:
  pid_t thread_ = 0;
  uint64_t sleeps_ = 0;
};

}  // namespace manycore
