// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "virtual_time/member.hpp"

#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <type_traits>
#include <utility>

#include "virtual_time/python_lock.hpp"

namespace manycore::virtual_time {
namespace {

/// What a poll that finds nothing takes from the second one at the same time on.
constexpr int64_t poll_ns = 100'000;
/// How soon a waiting thread notices that the timekeeper was killed.
constexpr int64_t look_after_ns = ns_per_s;

/// Without a destructor, so that those of other objects may read it at the end of the thread.
struct OfThread {
  Seat * seat = nullptr;
  Page * page = nullptr;
  bool is_left = false;
  bool has_asked = false;  ///< for the time: it is a thread of the program, not of a library
  bool is_in_callback = false;
  int64_t last_empty_poll_ns = 0;
  int64_t computed_from_ns = 0;  ///< CPU time of the thread
};
static_assert(std::is_trivially_destructible_v<OfThread>);

thread_local OfThread own;

/// Frees the thread's seat at its end. What the thread waits for later, as destructors of static
/// objects do, passes in wall time.
struct Leaving {
  Leaving() = default;
  Leaving(const Leaving &) = delete;
  Leaving & operator=(const Leaving &) = delete;
  ~Leaving() {
    own.is_left = true;
    if (own.seat != nullptr) {
      std::exchange(own.seat, nullptr)->vacate();
      own.page->changes.fetch_add(1, std::memory_order_seq_cst);
      futex_wake_one(own.page->changes);
    }
  }
  void prepare() noexcept {}
};

thread_local Leaving leaving;

/// A child of fork() inherits neither the thread's seat nor its place in virtual time.
void leave_in_child() noexcept {
  own.seat = nullptr;
  own.has_asked = false;
  if (Member * const member = Member::find()) {
    member->leave();
  }
}

}  // namespace

Member::Member(SharedMemory memory, uint32_t rank) noexcept
: memory_(std::move(memory)), page_(memory_.at<Page>(0)), rank_(rank) {}

Member * Member::find() noexcept {
  static Member * const member = attach();
  return member;
}

/// Never destroyed: threads may wait until the process ends.
Member * Member::attach() noexcept {
  const char * const path = std::getenv("MANYCORE_VIRTUAL_TIME");
  const char * const rank = std::getenv("MANYCORE_VIRTUAL_RANK");
  if (path == nullptr || rank == nullptr) {
    return nullptr;
  }
  try {
    SharedMemory memory = SharedMemory::attach(path);
    if (memory.size() < sizeof(Page) || memory.at<Page>(0).magic != page_magic) {
      std::fprintf(stderr, "[rmw_manycore] %s is not the time of this version\n", path);
      return nullptr;
    }
    pthread_atfork(nullptr, nullptr, leave_in_child);
    return new Member(std::move(memory), static_cast<uint32_t>(std::atoi(rank)));
  } catch (const std::exception & error) {
    std::fprintf(stderr, "[rmw_manycore] no virtual time: %s\n", error.what());
    return nullptr;
  }
}

int64_t Member::now_ns() const noexcept {
  own.has_asked = true;
  const int64_t now_ns = page_.now_ns.load(std::memory_order_acquire);
  return is_over() ? now_ns + monotonic_ns() - page_.over_at_ns.load(std::memory_order_relaxed)
                   : now_ns;
}

/// The timekeeper reads what this process's threads do, as a debugger would.
void Member::join() noexcept {
  if (has_joined_.exchange(true)) {
    return;
  }
  prctl(PR_SET_PTRACER, static_cast<unsigned long>(page_.timekeeper), 0, 0, 0);
  sleep_until(0);
}

bool Member::is_asked_by_this_thread() noexcept { return own.has_asked && find()->has_joined(); }

Seat * Member::seat_of_this_thread() noexcept {
  if (own.seat == nullptr && !own.is_left) {
    leaving.prepare();
    own.has_asked = true;
    own.seat = take_seat();
    own.page = &page_;
    own.computed_from_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  }
  return own.seat;
}

Seat * Member::take_seat() noexcept {
  for (uint32_t i = 0; i < seat_capacity; ++i) {
    Seat & seat = page_.seats[i];
    int32_t untaken = 0;
    if (!seat.pid.compare_exchange_strong(untaken, getpid(), std::memory_order_acq_rel)) {
      continue;
    }
    seat.tid = gettid();
    seat.rank = rank_;
    seat.ordinal = next_ordinal_.fetch_add(1, std::memory_order_relaxed);
    seat.state.store(seat_running, std::memory_order_release);
    uint32_t count = page_.seat_count.load(std::memory_order_relaxed);
    while (count <= i && !page_.seat_count.compare_exchange_weak(count, i + 1)) {
    }
    return &seat;
  }
  page_.seatless.store(getpid(), std::memory_order_relaxed);
  return nullptr;
}

/// After the timekeeper was killed, time goes on by itself.
void Member::end_if_alone() noexcept {
  if (kill(page_.timekeeper, 0) != 0 && errno == ESRCH) {
    page_.end();
  }
}

bool Member::wait_in(Seat & seat) noexcept {
  const PythonUnlocked unlocked;
  seat.state.store(seat_waiting, std::memory_order_seq_cst);
  page_.changes.fetch_add(1, std::memory_order_seq_cst);
  futex_wake_one(page_.changes);
  while (seat.state.load(std::memory_order_acquire) == seat_waiting) {
    if (is_over()) {
      uint32_t waiting = seat_waiting;
      seat.state.compare_exchange_strong(waiting, seat_running, std::memory_order_acq_rel);
      return false;
    }
    futex_wait(seat.state, seat_waiting, monotonic_ns() + look_after_ns);
    end_if_alone();
  }
  own.computed_from_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  return true;
}

bool Member::wait(const Awaited & awaited, int64_t due_ns) noexcept {
  Seat * const seat = is_over() || !has_joined() ? nullptr : seat_of_this_thread();
  if (seat == nullptr) {
    return false;
  }
  seat->process = awaited.process;
  seat->word = awaited.word;
  seat->seen = awaited.seen;
  seat->due_ns = due_ns;
  seat->next = Step::none;
  return wait_in(*seat);
}

bool Member::sleep_until(int64_t due_ns) noexcept { return wait({no_process, 0, 0}, due_ns); }

bool Member::yield(bool empty) noexcept {
  int64_t due_ns = now_ns();
  if (empty) {
    due_ns += own.last_empty_poll_ns == due_ns ? poll_ns : 0;
    own.last_empty_poll_ns = due_ns;
  }
  return sleep_until(due_ns);
}

void Member::end_turn(bool empty) noexcept {
  const int64_t at_ns = now_ns();
  if (page_.is_modelled == 0 || (empty && own.last_empty_poll_ns == at_ns)) {
    yield(empty);
  } else if (empty) {
    own.last_empty_poll_ns = at_ns;
  }
}

/// Between callbacks, only what begins one takes time.
bool Member::elapse(Step next, uint64_t subject) noexcept {
  own.has_asked = true;
  if (page_.is_modelled == 0) {
    return elapse_by_factor();
  }
  const bool begins = next == Step::take || next == Step::timer;
  if ((!begins && next != Step::woken && !own.is_in_callback) || is_over() || !has_joined()) {
    return true;
  }
  own.is_in_callback = begins || next == Step::publish;
  Seat * const seat = seat_of_this_thread();
  if (seat == nullptr) {
    return true;
  }
  seat->process = no_process;
  seat->due_ns = never_ns;
  seat->next = next;
  seat->subject = subject;
  return wait_in(*seat);
}

bool Member::has_arrived(uint32_t slot, uint32_t incarnation) const noexcept {
  return page_.under_way[slot].load(std::memory_order_acquire) != incarnation || is_over();
}

/// Of threads that never wait in the middleware, as executors have them, from the first step on.
bool Member::elapse_by_factor() noexcept {
  if (page_.factor <= 0 || is_over() || !has_joined() || seat_of_this_thread() == nullptr) {
    return true;
  }
  const int64_t computed_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID) - own.computed_from_ns;
  const auto passing_ns = static_cast<int64_t>(static_cast<double>(computed_ns) * page_.factor);
  return sleep_until(now_ns() + passing_ns);
}

}  // namespace manycore::virtual_time
