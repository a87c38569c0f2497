// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/registry_mutex.hpp"

#include <algorithm>
#include <utility>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/wall_sleep.hpp"

namespace manycore {
namespace {

constexpr int64_t others_first_ns = 100'000;

long left_until(int64_t deadline_ns) { return std::max<long>(deadline_ns - monotonic_ns(), 0); }

}  // namespace

RegistryMutex::RegistryMutex(
  RegistryHeader & header, const Lifelines & lifelines, const std::string & file)
: header_(header), lifelines_(lifelines), file_(file) {
  threads_.initialize();
}

/// The thread has ended when the kernel has marked what it held. The line proves more: while
/// it is held, its badge's owner lives, though another mark may mislead the kernel (RobustMutex).
/// A badge that does not exist is a damaged ticket, which no thread will give back.
bool RegistryMutex::has_ended(uint32_t badge) const {
  if (badge >= lock_badge_count) {
    return true;
  }
  const bool is_line_held = badge < lifeline_count && lifelines_.is_locked(badge);
  return !is_line_held && !header_.badges[badge].held.is_locked();
}

/// Holds the badge, or returns false at the deadline. The mark of a predecessor is gone: it is
/// dead, or this thread is a guest.
bool RegistryMutex::hold(uint32_t badge, int64_t deadline_ns) {
  LockBadge & own = header_.badges[badge];
  const RobustMutex::Outcome outcome = own.held.lock(left_until(deadline_ns));
  if (outcome == RobustMutex::Outcome::timed_out) {
    return false;
  }
  if (outcome == RobustMutex::Outcome::owner_died) {
    own.held.mark_consistent();
  }
  own.pid_namespace = pid_namespace_;
  return true;
}

/// The file stays locked until the badge is given back, and the kernel opens it to the next guest
/// only after the last thread of a killed one has ended, as RobustMutex requires. A mark that is
/// found then is one that the kernel failed to clear. False at the deadline if the registry is
/// locked; throws Error{timeout} if only a guest keeps this one from trying.
bool RegistryMutex::lock_guest_file(Taken & taken, int64_t deadline_ns) {
  try {
    const int wait_ms = static_cast<int>(left_until(deadline_ns) / (ns_per_s / 1000));
    taken.guest_file = FileLock::acquire_existing(file_, wait_ms);
  } catch (const Error & error) {
    if (error.code() == ErrorCode::timeout && header_.mutex.owner()) {
      return false;
    }
    throw;
  }
  if (!taken.guest_file) {
    throw Error(ErrorCode::system, file_ + " was removed; try again");
  }
  RobustMutex & held = header_.badges[guest_badge].held;
  held.mark_owner_died(held.owner());
  return true;
}

std::optional<RegistryMutex::Taken> RegistryMutex::try_take(long wait_ns) {
  const int64_t deadline_ns = monotonic_ns() + wait_ns;
  const RobustMutex::Outcome outcome = threads_.lock(wait_ns);
  if (outcome == RobustMutex::Outcome::timed_out) {
    return std::nullopt;
  }
  if (outcome == RobustMutex::Outcome::owner_died) {
    threads_.mark_consistent();
  }
  try {
    if (
      std::optional<Taken> taken = take_with(line_ == nothing ? guest_badge : line_, deadline_ns)) {
      return taken;
    }
  } catch (...) {
    threads_.unlock();
    throw;
  }
  threads_.unlock();
  return std::nullopt;
}

std::optional<RegistryMutex::Taken> RegistryMutex::take_with(uint32_t badge, int64_t deadline_ns) {
  Taken taken{badge, false, {}};
  if (badge == guest_badge && !lock_guest_file(taken, deadline_ns)) {
    return std::nullopt;
  }
  if (!hold(badge, deadline_ns)) {
    return std::nullopt;
  }
  LockBadge & own = header_.badges[badge];
  try {
    const auto outcome = header_.mutex.lock(
      badge, own, [this](uint32_t other) { return has_ended(other); }, left_until(deadline_ns));
    if (outcome != RecoverableMutex::Outcome::timed_out) {
      taken.owner_died = outcome == RecoverableMutex::Outcome::owner_died;
      return taken;
    }
  } catch (...) {
    own.held.unlock();
    throw;
  }
  own.held.unlock();
  return std::nullopt;
}

/// A caller that does not wait retries by itself, so the owner is not described.
void RegistryMutex::refuse(long wait_ns) const {
  throw Error(
    ErrorCode::timeout, wait_ns == no_wait_ns ? "the platform's registry is locked"
                                              : "the platform's registry stayed locked: " +
                                                  describe_lock_owner(owner()));
}

RegistryMutex::Taken RegistryMutex::take(long wait_ns) {
  if (wait_ns >= usual_wait_ns) {
    let_others_go_first();
  }
  if (std::optional<Taken> taken = try_take(wait_ns)) {
    stayed_locked_ = false;
    return std::move(*taken);
  }
  stayed_locked_ = stayed_locked_ || wait_ns >= usual_wait_ns;
  refuse(wait_ns);
}

RegistryMutex::Taken RegistryMutex::take_while_owners_run() {
  const int64_t until_ns = monotonic_ns() + usual_wait_ns;
  LockOwnerWatch watch;
  while (true) {
    const uint64_t changes = header_.changes.load();
    if (std::optional<Taken> taken = try_take(short_wait_ns)) {
      return std::move(*taken);
    }
    const bool has_moved = header_.changes.load() != changes;
    if (monotonic_ns() >= until_ns || !(has_moved || watch.may_unlock(owner()))) {
      refuse(short_wait_ns);
    }
  }
}

void RegistryMutex::give_back(Taken & taken) noexcept {
  if (is_waited_for(taken.badge)) {
    others_first_until_ns_.store(monotonic_ns() + others_first_ns, std::memory_order_relaxed);
  }
  header_.mutex.unlock(taken.badge);
  header_.badges[taken.badge].held.unlock();
  taken.guest_file.reset();
  threads_.unlock();
}

/// A woken thread needs about 50 us to run. Without this wait, a thread that creates many endpoints
/// in a row would retake the lock each time before a waiting thread runs.
void RegistryMutex::let_others_go_first() const noexcept {
  const int64_t until_ns = others_first_until_ns_.load(std::memory_order_relaxed);
  if (monotonic_ns() < until_ns) {
    wall_sleep_until(until_ns);
  }
}

bool RegistryMutex::is_waited_for(uint32_t badge) const noexcept {
  return header_.mutex.is_waited_for() || threads_.is_waited_for() ||
         header_.badges[badge].held.is_waited_for();
}

long RegistryMutex::parting_wait_ns() const noexcept {
  return stayed_locked_ ? short_wait_ns : usual_wait_ns;
}

LockOwner RegistryMutex::owner() const noexcept {
  const std::optional<uint32_t> badge = header_.mutex.owner();
  if (!badge || *badge >= lock_badge_count) {
    return {};
  }
  const LockBadge & taken = header_.badges[*badge];
  return {taken.held.owner(), taken.pid_namespace};
}

}  // namespace manycore
