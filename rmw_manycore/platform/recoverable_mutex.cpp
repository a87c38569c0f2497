// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/recoverable_mutex.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "platform/cpu.hpp"
#include "platform/futex.hpp"

namespace manycore {
namespace {

// A ticket: | takes : 52 | badge + 1 : 11 | waiters : 1 |. The flag lies in the lower half, on
// which waiting threads sleep.
constexpr uint64_t waiters = 1;
constexpr int badge_shift = 1;
constexpr int takes_shift = 12;
constexpr uint64_t badge_mask = (uint64_t{1} << (takes_shift - badge_shift)) - 1;

// A waiting thread looks at the owner by itself now and then: nothing wakes it if the thread that
// was to wake it is killed before it does.
constexpr int64_t first_look_ns = 1'000'000;
constexpr int64_t last_look_ns = 128'000'000;

// As long as it takes to sleep and be woken. Most holds end within a few microseconds.
constexpr int64_t spin_ns = 50'000;

constexpr uint64_t make_ticket(uint32_t badge, uint64_t takes) {
  return takes << takes_shift | (uint64_t{badge} + 1) << badge_shift;
}

/// Not a badge's number if the ticket is damaged.
constexpr uint32_t badge_of(uint64_t ticket) {
  return static_cast<uint32_t>(ticket >> badge_shift & badge_mask) - 1;
}

/// The lower half of the ticket; only its address is used.
FutexWord & lower_half_of(std::atomic<uint64_t> & ticket) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
  return reinterpret_cast<FutexWord &>(ticket);
}

}  // namespace

/// Acquire: what the last owner changed is seen. Release: a thread that sees the ticket also sees
/// that its badge is held. A failure leaves the ticket found in `seen`.
bool RecoverableMutex::try_take(uint64_t & seen, uint64_t ticket) noexcept {
  return ticket_.compare_exchange_strong(seen, ticket, std::memory_order_acq_rel);
}

bool RecoverableMutex::announce_waiter(uint64_t & seen) noexcept {
  if ((seen & waiters) == 0) {
    if (!ticket_.compare_exchange_strong(seen, seen | waiters, std::memory_order_acquire)) {
      return false;
    }
    seen |= waiters;
  }
  return true;
}

/// True if this thread took the mutex. A thread that finds another one waiting sleeps at once: it
/// would overtake that one.
bool RecoverableMutex::spin(uint64_t & seen, uint64_t ticket) noexcept {
  const int64_t until_ns = monotonic_ns() + spin_ns;
  while ((seen & waiters) == 0 && monotonic_ns() < until_ns) {
    pause_cpu();
    seen = 0;
    if (ticket_.load(std::memory_order_relaxed) == 0 && try_take(seen, ticket)) {
      return true;
    }
    seen = ticket_.load(std::memory_order_acquire);
  }
  return false;
}

void RecoverableMutex::sleep(uint64_t seen, int64_t until_ns) noexcept {
  futex_wait(lower_half_of(ticket_), static_cast<uint32_t>(seen), until_ns);
}

RecoverableMutex::Outcome RecoverableMutex::lock(
  uint32_t badge, LockBadge & own, const HasEnded & has_ended, long timeout_ns) {
  const uint64_t ticket = make_ticket(badge, ++own.takes);
  uint64_t seen = 0;
  if (try_take(seen, ticket) || (timeout_ns > 0 && spin(seen, ticket))) {
    return Outcome::locked;
  }
  int64_t now_ns = monotonic_ns();
  const int64_t deadline_ns = now_ns + timeout_ns;
  int64_t look_ns = first_look_ns;
  while (true) {
    // If the ticket is still there when this thread takes the mutex, its owner has not unlocked,
    // and has ended, so it never will. A ticket of this thread's own badge is that of a
    // predecessor.
    const bool owner_died = seen != 0 && (badge_of(seen) == badge || has_ended(badge_of(seen)));
    if (seen == 0 || owner_died) {
      // Other threads may be asleep, so the flag stays set.
      if (try_take(seen, ticket | waiters)) {
        return owner_died ? Outcome::owner_died : Outcome::locked;
      }
      continue;
    }
    // Announced also by a thread that leaves: a wake-up may have reached it instead of another one.
    if (timeout_ns > 0 && !announce_waiter(seen)) {
      continue;
    }
    if (now_ns >= deadline_ns) {
      return Outcome::timed_out;
    }
    sleep(seen, std::min(deadline_ns, now_ns + look_ns));
    look_ns = std::min(2 * look_ns, last_look_ns);
    seen = ticket_.load(std::memory_order_acquire);
    now_ns = monotonic_ns();
  }
}

/// Release: the next owner sees what this one changed. A damaged ticket is left alone.
void RecoverableMutex::unlock(uint32_t badge) noexcept {
  uint64_t seen = ticket_.load(std::memory_order_relaxed);
  while (badge_of(seen) == badge) {
    if (ticket_.compare_exchange_weak(seen, 0, std::memory_order_release)) {
      if ((seen & waiters) != 0) {
        futex_wake_one(lower_half_of(ticket_));
      }
      return;
    }
  }
}

std::optional<uint32_t> RecoverableMutex::owner() const noexcept {
  const uint64_t seen = ticket_.load(std::memory_order_acquire);
  return seen == 0 ? std::nullopt : std::optional(badge_of(seen));
}

bool RecoverableMutex::is_waited_for() const noexcept {
  return (ticket_.load(std::memory_order_relaxed) & waiters) != 0;
}

}  // namespace manycore
