// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "platform/clock.hpp"

/// What the middleware calls of the library that a run in virtual time preloads into its processes.
/// Without that library there is no door, and time is the wall clock's.
namespace manycore::virtual_time {

/// `Awaited::process` of a wait that only its due time ends.
constexpr uint32_t no_process = UINT32_MAX;

/// The wake word that ends a wait, in the slot `process` of the registry.
struct Awaited {
  uint32_t process;
  uint32_t word;
  uint32_t seen;  ///< the wait ends when its epoch is another one
};

/// What a thread is about to do when the time before it has passed.
enum class Step : uint32_t {
  none,
  wait,     ///< its callback has ended
  woken,    ///< look at what has ended its wait
  timer,    ///< call a timer; subject: its period in ns
  take,     ///< take a message; subject: the subscription's slot
  publish,  ///< subject: the publisher's slot
};

struct Door {
  /// Virtual time, of all clocks.
  int64_t (*now_ns)() noexcept;
  /// Blocks until it is this program's turn to start. Only the first call of a process does.
  void (*join)() noexcept;
  /// Blocks until the timekeeper lets this thread go on: the epoch has changed or it is `due_ns`.
  /// False if time is not virtual any more, or the process has not joined.
  bool (*wait)(const Awaited & awaited, int64_t due_ns) noexcept;
  /// Lets the others that are due now go first. An `empty` poll, repeated at the same time, takes
  /// time: a loop of polls comes to its end. False as wait().
  bool (*yield)(bool empty) noexcept;
  /// Likewise, before a wait that does not block. Where the platform is modelled, the thread keeps
  /// its turn, and so its CPU, unless it polls again.
  void (*end_turn)(bool empty) noexcept;
  /// Lets the time pass that this thread takes on the platform before a step. False if virtual time
  /// ended meanwhile.
  bool (*elapse)(Step next, uint64_t subject) noexcept;
  /// Whether a subscription's messages have arrived on the modelled platform, any of them.
  bool (*has_arrived)(uint32_t slot, uint32_t incarnation) noexcept;
};

}  // namespace manycore::virtual_time

extern "C" {
/// The door, or nullptr in a process that no run in virtual time has started. Defined by the
/// preloaded library only.
[[gnu::weak, gnu::visibility("default")]] const manycore::virtual_time::Door *
manycore_virtual_time() noexcept;
}

namespace manycore::virtual_time {

/// Nullptr where time is the wall clock's.
inline const Door * door() noexcept {
  return manycore_virtual_time == nullptr ? nullptr : manycore_virtual_time();
}

inline void elapse(Step next, uint64_t subject = 0) noexcept {
  if (const Door * const there = door()) {
    there->elapse(next, subject);
  }
}

/// True where time is the wall clock's.
inline bool has_arrived(uint32_t slot, uint32_t incarnation) noexcept {
  const Door * const there = door();
  return there == nullptr || there->has_arrived(slot, incarnation);
}

/// To be called before a wait, which is a turn's end also if it finds something ready. `poll`: it
/// does not block.
template<typename IsAnyReady>
void end_turn(bool poll, const IsAnyReady & is_any_ready) {
  const Door * const there = door();
  if (there == nullptr) {
    return;
  }
  there->elapse(Step::wait, 0);
  const bool is_ready = is_any_ready();
  if (poll || is_ready) {
    there->end_turn(!is_ready);
  }
}

}  // namespace manycore::virtual_time

namespace manycore {

/// Clock of QoS: deadlines, leases and timeouts of users. CLOCK_MONOTONIC or virtual time.
inline int64_t qos_now_ns() noexcept {
  const virtual_time::Door * const door = virtual_time::door();
  return door == nullptr ? monotonic_ns() : door->now_ns();
}

/// CLOCK_MONOTONIC at a time of qos_now_ns(), for waits in the kernel.
inline int64_t kernel_time_of(int64_t qos_ns) noexcept {
  return virtual_time::door() == nullptr ? qos_ns : monotonic_ns() + (qos_ns - qos_now_ns());
}

/// Clock of message timestamps and lifespans. CLOCK_REALTIME or virtual time.
inline int64_t stamp_now_ns() noexcept {
  const virtual_time::Door * const door = virtual_time::door();
  return door == nullptr ? realtime_ns() : door->now_ns();
}

/// Time of a publication, once the time has passed that was spent on it.
inline int64_t publish_now_ns(uint32_t publisher) noexcept {
  const virtual_time::Door * const door = virtual_time::door();
  if (door == nullptr) {
    return realtime_ns();
  }
  door->elapse(virtual_time::Step::publish, publisher);
  return door->now_ns();
}

}  // namespace manycore
