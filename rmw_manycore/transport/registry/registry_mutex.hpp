// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "platform/file_lock.hpp"
#include "platform/lifeline.hpp"
#include "platform/lock_owner.hpp"
#include "transport/layout/registry_layout.hpp"

namespace manycore {

/// The registry lock as this process takes it: with the badge of the line that it holds, or with
/// the guest badge. See docs/design/registry_lock.md.
class RegistryMutex {
public:
  static constexpr long usual_wait_ns = 5'000'000'000;
  static constexpr long short_wait_ns = 100'000'000;  ///< from inside a publish
  static constexpr long no_wait_ns = 0;

  /// The lock, taken.
  struct Taken {
    uint32_t badge;
    bool owner_died;
    std::optional<FileLock> guest_file;  ///< keeps other guests out
  };

  RegistryMutex(RegistryHeader & header, const Lifelines & lifelines, const std::string & file);

  /// From now on takes the lock with the badge of a line that this process holds, until it has left
  /// the platform. Called before other threads use this object.
  void use_badge_of(uint32_t line) noexcept { line_ = line; }

  /// Throws Error{timeout} after `wait_ns`. A thread that retakes the lock at once first lets
  /// waiting threads run, unless `wait_ns` is short.
  Taken take(long wait_ns);
  /// Waits `usual_wait_ns` while owners run or wait for a CPU, but only `short_wait_ns` for an
  /// owner that is stopped or not visible in this PID namespace.
  Taken take_while_owners_run();
  void give_back(Taken & taken) noexcept;

  /// True if a thread may be waiting for the caller, the owner.
  bool is_waited_for(uint32_t badge) const noexcept;
  /// See Registry::parting_wait_ns().
  long parting_wait_ns() const noexcept;
  /// The thread that owns the lock at this moment.
  LockOwner owner() const noexcept;

private:
  bool has_ended(uint32_t badge) const;
  bool lock_guest_file(Taken & taken, int64_t deadline_ns);
  bool hold(uint32_t badge, int64_t deadline_ns);
  std::optional<Taken> try_take(long wait_ns);
  std::optional<Taken> take_with(uint32_t badge, int64_t deadline_ns);
  [[noreturn]] void refuse(long wait_ns) const;
  void let_others_go_first() const noexcept;

  RegistryHeader & header_;
  const Lifelines & lifelines_;
  const std::string file_;
  const uint64_t pid_namespace_ = own_pid_namespace();
  uint32_t line_ = nothing;
  /// Of this process's threads, in its own memory: so one of them at a time locks the mutex of the
  /// badge, and none is killed while it waits for that.
  RobustMutex threads_;
  std::atomic<bool> stayed_locked_{false};
  std::atomic<int64_t> others_first_until_ns_{0};  ///< CLOCK_MONOTONIC
};

}  // namespace manycore
