// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Waiter, the only place where a process sleeps. The stress cannot prove that no wake-up is ever
// lost; a lost one shows as a wait that ends by its deadline.
#include <doctest/doctest.h>

#include <csignal>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "platform/clock.hpp"
#include "platform/futex_any.hpp"
#include "transport/layout/wake_words.hpp"
#include "transport/waiting/joint_wait.hpp"
#include "transport/waiting/waiter.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr WaitMode modes[] = {WaitMode::block, WaitMode::adaptive, WaitMode::spin};

struct Side {
  explicit Side(WaitMode mode) : waiter(word, mode) {}
  WakeWord word{};
  Waiter waiter;
};

int64_t long_from_now() { return monotonic_ns() + timeout_s * ns_per_s; }

/// Passes `ball` to the other side and back, `rounds` times; returns how many waits ended by their
/// deadline.
int play(Side & own, Side & other, std::atomic<int> & ball, int own_parity, int rounds) {
  int missed = 0;
  for (int i = 0; i < rounds; ++i) {
    while (true) {
      const uint32_t epoch = own.waiter.epoch();
      if (ball % 2 == own_parity) {
        break;
      }
      if (!own.waiter.wait(epoch, long_from_now())) {
        ++missed;
        break;
      }
    }
    ++ball;
    other.waiter.notify();
  }
  return missed;
}

}  // namespace

TEST_CASE("a wait for something that has already happened returns at once") {
  for (const WaitMode mode : modes) {
    Side side(mode);
    const uint32_t seen = side.waiter.epoch();
    side.waiter.notify();
    CHECK(side.waiter.wait(seen, std::nullopt));
    CHECK(side.waiter.wait(seen, 0));  // even after its deadline
    CHECK(side.word.sleepers == 0);
  }
}

TEST_CASE("a wait ends at its deadline, and not before") {
  for (const WaitMode mode : modes) {
    Side side(mode);
    for (const int64_t duration_ns : {0, 1000, 2'000'000}) {
      const int64_t deadline = monotonic_ns() + duration_ns;
      CHECK_FALSE(side.waiter.wait(side.waiter.epoch(), deadline));
      CHECK(monotonic_ns() >= deadline);
      CHECK(side.word.sleepers == 0);
    }
  }
}

TEST_CASE("one notification wakes all waiting threads") {
  for (const WaitMode mode : modes) {
    Side side(mode);
    const uint32_t seen = side.waiter.epoch();
    std::vector<std::future<bool>> woken;
    for (int i = 0; i < 4; ++i) {
      woken.push_back(
        std::async(std::launch::async, [&] { return side.waiter.wait(seen, long_from_now()); }));
    }
    if (mode == WaitMode::block) {
      wait_until("all sleep", [&] { return side.word.sleepers == 4; });
    }
    side.waiter.notify();
    for (std::future<bool> & one : woken) {
      CHECK(one.get());
    }
    CHECK(side.word.sleepers == 0);
  }
}

TEST_CASE("a signal ends a sleep only where that was asked for") {
  struct sigaction note {};
  note.sa_handler = [](int) {};  // without SA_RESTART, as Python installs its handlers
  struct sigaction before {};
  sigaction(SIGUSR1, &note, &before);
  for (const OnSignal on_signal : {OnSignal::resume, OnSignal::give_up}) {
    Side side(WaitMode::block);
    const uint32_t seen = side.waiter.epoch();
    std::atomic<bool> ended{false};
    bool woken = false;
    std::thread sleeper([&] {
      woken = side.waiter.wait(seen, std::nullopt, on_signal);
      ended = true;
    });
    wait_until("it sleeps", [&] { return side.word.sleepers == 1; });
    if (on_signal == OnSignal::give_up) {
      wait_until("the sleep ends", [&] {
        pthread_kill(sleeper.native_handle(), SIGUSR1);
        return ended.load();
      });
    } else {
      pthread_kill(sleeper.native_handle(), SIGUSR1);
      side.waiter.notify();
    }
    sleeper.join();
    CHECK(woken == (on_signal == OnSignal::resume));
    CHECK(side.word.sleepers == 0);
  }
  sigaction(SIGUSR1, &before, nullptr);
}

TEST_CASE("no wake-up is lost: a ball goes back and forth between all pairs of modes") {
  for (const WaitMode mine : modes) {
    for (const WaitMode theirs : modes) {
      const bool both_spin = mine == WaitMode::spin && theirs == WaitMode::spin;
      const int rounds = both_spin ? 100 : 3000;  // spinning on a busy machine costs time slices
      Side here(mine);
      Side there(theirs);
      std::atomic<int> ball{0};
      auto other =
        std::async(std::launch::async, [&] { return play(there, here, ball, 1, rounds); });
      CHECK(play(here, there, ball, 0, rounds) == 0);
      CHECK(other.get() == 0);
    }
  }
}

TEST_CASE("no wake-up is lost: many threads notify one that counts") {
  for (const WaitMode mode : {WaitMode::block, WaitMode::adaptive}) {
    Side side(mode);
    constexpr int each = 5000;
    std::atomic<int> sent{0};
    std::vector<std::future<void>> senders;
    for (int i = 0; i < 3; ++i) {
      senders.push_back(std::async(std::launch::async, [&] {
        for (int k = 0; k < each; ++k) {
          ++sent;
          side.waiter.notify();
        }
      }));
    }
    bool missed = false;
    while (!missed) {
      const uint32_t epoch = side.waiter.epoch();
      if (sent == 3 * each) {
        break;
      }
      missed = !side.waiter.wait(epoch, long_from_now());
    }
    CHECK_FALSE(missed);
  }
}

TEST_CASE("a wait on several platforms ends with a notification on any of them") {
  for (const size_t notified : {0, 1, 2}) {
    std::vector<std::unique_ptr<Side>> sides;
    std::vector<SeenEpoch> seen;
    for (int i = 0; i < 3; ++i) {
      sides.push_back(std::make_unique<Side>(WaitMode::block));
      seen.push_back({&sides.back()->waiter, sides.back()->waiter.epoch()});
    }
    std::future<bool> woken =
      std::async(std::launch::async, [&] { return wait_for_any(seen, long_from_now()); });
    wait_until("it sleeps everywhere", [&] {
      return sides[0]->word.sleepers + sides[1]->word.sleepers + sides[2]->word.sleepers == 3;
    });
    sides[notified]->waiter.notify();
    CHECK(woken.get());
    CHECK(wait_for_any(seen, 0));  // changed before the wait, even after the deadline
    CHECK(sides[notified]->word.sleepers == 0);
  }
}

TEST_CASE("a wait on several platforms ends at its deadline, and not before") {
  Side one(WaitMode::block), other(WaitMode::spin);
  const std::vector<SeenEpoch> seen{
    {&one.waiter, one.waiter.epoch()}, {&other.waiter, other.waiter.epoch()}};
  for (const int64_t duration_ns : {0, 1000, 2'000'000}) {
    const int64_t deadline = monotonic_ns() + duration_ns;
    CHECK_FALSE(wait_for_any(seen, deadline));
    CHECK(monotonic_ns() >= deadline);
  }
}

TEST_CASE("more words than the kernel supports at once are polled") {
  FutexWord word{};
  std::vector<AwaitedWord> words(129, AwaitedWord(word, 0));
  const int64_t before = monotonic_ns();
  futex_wait_any(words, std::nullopt);  // returns by itself
  CHECK(monotonic_ns() > before);
  const int64_t deadline = monotonic_ns() + 1000;
  futex_wait_any(words, deadline);
  CHECK(monotonic_ns() >= deadline);
}
