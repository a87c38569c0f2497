// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Functions of rcutils, rcl and libc that a run in virtual time replaces in its processes. The
// library is preloaded, so these are found first (docs/design/virtual_time.md).

#include <dlfcn.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "virtual_time/member.hpp"

using manycore::ns_per_s;
using manycore::virtual_time::Door;
using manycore::virtual_time::Member;
using manycore::virtual_time::Step;

namespace {

/// The function of the same name in the libraries behind this one.
template<typename Function>
Function * next(const char * name) noexcept {
  return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name));
}

/// Of librcl, which is not behind this library where Python has loaded it.
template<typename Function>
Function * in_rcl(const char * name) noexcept {
  static void * const rcl = dlopen("librcl.so", RTLD_LAZY | RTLD_NOLOAD);
  return rcl == nullptr ? nullptr : reinterpret_cast<Function *>(dlsym(rcl, name));
}

/// Nullptr in a process whose time is the wall clock's: it has not joined, or time is over.
Member * joined() noexcept {
  Member * const member = Member::find();
  return member != nullptr && member->has_joined() && !member->is_over() ? member : nullptr;
}

int64_t ns_of(const timespec & time) noexcept { return time.tv_sec * ns_per_s + time.tv_nsec; }

/// What the thread read last of CLOCK_MONOTONIC, which stays the wall clock's: an absolute sleep
/// that follows is taken as one of the difference.
[[gnu::tls_model("initial-exec")]] thread_local int64_t last_monotonic_ns = 0;

int real_sleep(clockid_t clock, int flags, const timespec * request, timespec * remain) {
  static auto * const real =
    next<int(clockid_t, int, const timespec *, timespec *)>("clock_nanosleep");
  return real(clock, flags, request, remain);
}

/// As clock_nanosleep(). What is left when virtual time ends passes by the wall clock.
int sleep_for(Member & member, int64_t duration_ns, timespec * remain) {
  const int64_t due_ns = member.now_ns() + std::max<int64_t>(duration_ns, 0);
  if (member.sleep_until(due_ns)) {
    return 0;
  }
  const timespec left = manycore::to_timespec(std::max<int64_t>(due_ns - member.now_ns(), 0));
  return real_sleep(CLOCK_MONOTONIC, 0, &left, remain);
}

int with_errno(int error) noexcept {
  errno = error;
  return error == 0 ? 0 : -1;
}

const Door the_door{
  []() noexcept { return Member::find()->now_ns(); },
  []() noexcept { Member::find()->join(); },
  [](const manycore::virtual_time::Awaited & awaited, int64_t due_ns) noexcept {
    return Member::find()->wait(awaited, due_ns);
  },
  [](bool empty) noexcept { return Member::find()->yield(empty); },
  [](bool empty) noexcept { Member::find()->end_turn(empty); },
  [](Step next, uint64_t subject) noexcept { return Member::find()->elapse(next, subject); },
  [](uint32_t slot, uint32_t incarnation) noexcept {
    return Member::find()->has_arrived(slot, incarnation);
  },
};

}  // namespace

#define INTERPOSED extern "C" [[gnu::visibility("default")]]

INTERPOSED const Door * manycore_virtual_time() noexcept {
  return Member::find() == nullptr ? nullptr : &the_door;
}

INTERPOSED int rcutils_steady_time_now(int64_t * now) {
  Member * const member = Member::find();
  *now = member == nullptr ? manycore::monotonic_ns() : member->now_ns();
  return 0;
}

INTERPOSED int rcutils_system_time_now(int64_t * now) {
  Member * const member = Member::find();
  *now = member == nullptr ? manycore::realtime_ns() : member->now_ns();
  return 0;
}

/// The time of a node with use_sim_time is the virtual one, not the last one of /clock: its timers
/// then have due times like all others.
INTERPOSED int rcl_enable_ros_time_override(void * clock) {
  if (Member::find() != nullptr) {
    return 0;
  }
  static auto * const real = next<int(void *)>("rcl_enable_ros_time_override");
  return real == nullptr ? 1 : real(clock);
}

/// A callback of a timer begins with it. rcl_timer_call() calls it, too.
INTERPOSED int rcl_timer_call_with_info(void * timer, void * info) {
  static auto * const real = in_rcl<int(void *, void *)>("rcl_timer_call_with_info");
  static auto * const period_of = in_rcl<int(const void *, int64_t *)>("rcl_timer_get_period");
  if (real == nullptr || period_of == nullptr) {
    return 1;
  }
  int64_t period_ns = 0;
  if (Member * const member = joined(); member != nullptr && period_of(timer, &period_ns) == 0) {
    member->elapse(Step::timer, static_cast<uint64_t>(period_ns));
  }
  return real(timer, info);
}

/// The callback before ends here, not in rmw_wait, whose timeout rcl computes from the due times of
/// timers: those would be late by what passes.
INTERPOSED int rcl_wait(void * wait_set, int64_t timeout_ns) {
  static auto * const real = in_rcl<int(void *, int64_t)>("rcl_wait");
  if (real == nullptr) {
    return 1;
  }
  if (Member * const member = joined()) {
    member->elapse(Step::wait, 0);
  }
  return real(wait_set, timeout_ns);
}

/// Threads that have not come through the middleware keep the wall clock: those of libraries wait
/// in locks with timeouts of the kernel.
INTERPOSED int clock_gettime(clockid_t clock, timespec * time) noexcept {
  static auto * const real = next<int(clockid_t, timespec *)>("clock_gettime");
  const int result = real(clock, time);
  if (clock == CLOCK_MONOTONIC) {
    last_monotonic_ns = ns_of(*time);
  } else if (clock == CLOCK_REALTIME && Member::is_asked_by_this_thread()) {
    *time = manycore::to_timespec(Member::find()->now_ns());
  }
  return result;
}

INTERPOSED int clock_nanosleep(
  clockid_t clock, int flags, const timespec * request, timespec * remain) {
  Member * const member = joined();
  if (member == nullptr) {
    return real_sleep(clock, flags, request, remain);
  }
  int64_t from_ns = 0;
  if ((flags & TIMER_ABSTIME) != 0) {
    from_ns = clock == CLOCK_REALTIME ? manycore::realtime_ns() : last_monotonic_ns;
  }
  return sleep_for(*member, ns_of(*request) - from_ns, remain);
}

INTERPOSED int nanosleep(const timespec * request, timespec * remain) {
  if (Member * const member = joined()) {
    return with_errno(sleep_for(*member, ns_of(*request), remain));
  }
  static auto * const real = next<int(const timespec *, timespec *)>("nanosleep");
  return real(request, remain);
}

INTERPOSED int usleep(useconds_t duration_us) {
  if (Member * const member = joined()) {
    return with_errno(sleep_for(*member, int64_t{duration_us} * 1000, nullptr));
  }
  static auto * const real = next<int(useconds_t)>("usleep");
  return real(duration_us);
}

/// Without descriptors it is a sleep: time.sleep() of Python 3.10.
INTERPOSED int select(
  int count, fd_set * readable, fd_set * writable, fd_set * exceptional, timeval * timeout) {
  Member * const member = count == 0 && timeout != nullptr ? joined() : nullptr;
  if (member != nullptr) {
    const int64_t duration_ns = timeout->tv_sec * ns_per_s + timeout->tv_usec * 1000;
    return with_errno(sleep_for(*member, duration_ns, nullptr));
  }
  static auto * const real = next<int(int, fd_set *, fd_set *, fd_set *, timeval *)>("select");
  return real(count, readable, writable, exceptional, timeout);
}
