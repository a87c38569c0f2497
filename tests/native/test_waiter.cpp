// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The one place where a process sleeps. The stress cannot prove that no wake-up is ever lost; one
// that is shows as a wait that ends by its deadline.
#include <doctest/doctest.h>

#include <future>
#include <memory>
#include <vector>

#include "patience.hpp"
#include "platform/clock.hpp"
#include "platform/futex_any.hpp"
#include "transport/layout/wake_words.hpp"
#include "transport/waiting/joint_wait.hpp"
#include "transport/waiting/waiter.hpp"

using namespace manycore;

namespace {

constexpr WaitMode modes[] = {WaitMode::block, WaitMode::adaptive, WaitMode::spin};

struct Side {
  explicit Side(WaitMode mode) : waiter(word, mode) {}
  WakeWord word{};
  Waiter waiter;
};

int64_t long_from_now() { return monotonic_ns() + patience_s * ns_per_s; }

/// Passes `ball` to the other side and back, `rounds` times; how often a wait ended by its
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

TEST_CASE("a wait for what has happened already ends at once") {
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

TEST_CASE("one notification wakes all who wait") {
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

TEST_CASE("no wake-up is lost: a ball goes back and forth between each two modes") {
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

TEST_CASE("no wake-up is lost: many notify one who counts") {
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
    CHECK(wait_for_any(seen, 0));  // what has happened already, even after the deadline
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

TEST_CASE("more words than the kernel takes at once are looked at again and again") {
  FutexWord word{};
  std::vector<AwaitedWord> words(129, AwaitedWord(word, 0));
  const int64_t before = monotonic_ns();
  futex_wait_any(words, std::nullopt);  // comes back by itself
  CHECK(monotonic_ns() > before);
  const int64_t deadline = monotonic_ns() + 1000;
  futex_wait_any(words, deadline);
  CHECK(monotonic_ns() >= deadline);
}
