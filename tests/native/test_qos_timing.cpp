// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// DEADLINE and LIVELINESS: counts, wake-ups, and killed publishers. Durations are either so short
// that they only have to pass at some point, or so long that they cannot pass during a test.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform/clock.hpp"
#include "transport/layout/deadline_clock.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr int64_t short_ns = 5'000'000;
constexpr int64_t long_ns = 3600 * ns_per_s;

Qos with_deadline(int64_t deadline_ns) {
  Qos qos = keep_last(10);
  qos.deadline_ns = deadline_ns;
  return qos;
}

Qos with_lease(int64_t lease_ns, Liveliness liveliness) {
  Qos qos = keep_last(10);
  qos.liveliness = liveliness;
  qos.liveliness_lease_ns = lease_ns;
  return qos;
}

struct Fixture {
  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};

  std::unique_ptr<Publisher> publisher(const Qos & qos) {
    return process->create_publisher(on_topic("/x", qos));
  }
  std::unique_ptr<Subscription> subscription(const Qos & qos) {
    return process->create_subscription(on_topic("/x", qos));
  }
};

bool is_soon(int64_t due_ns, int64_t duration_ns) {
  return due_ns != infinite_ns && due_ns <= monotonic_ns() + duration_ns;
}

}  // namespace

TEST_CASE("one word counts periods: a message keeps the count and starts a new period") {
  constexpr uint64_t period = 100;
  uint64_t origin = DeadlineClock::not_started;
  CHECK(DeadlineClock::missed_at(origin, 5000, period) == 0);
  origin = DeadlineClock::moved(origin, 5000, period);
  CHECK(DeadlineClock::missed_at(origin, 5099, period) == 0);
  CHECK(DeadlineClock::missed_at(origin, 5100, period) == 1);
  CHECK(DeadlineClock::missed_at(origin, 5350, period) == 3);
  origin = DeadlineClock::moved(origin, 5350, period);
  CHECK(DeadlineClock::missed_at(origin, 5350, period) == 3);
  CHECK(DeadlineClock::missed_at(origin, 5449, period) == 3);
  CHECK(DeadlineClock::missed_at(origin, 5450, period) == 4);
  origin = DeadlineClock::moved(origin, 5449, period);
  CHECK(DeadlineClock::missed_at(origin, 5548, period) == 3);
}

TEST_CASE(
  "without a deadline, and before the first message, nothing is missed and nothing falls due") {
  Fixture f;
  for (const int64_t period : {infinite_ns, short_ns}) {
    const auto publisher = f.publisher(with_deadline(period));
    const auto subscription = f.subscription(with_deadline(period));
    if (period == infinite_ns) {
      publish(*publisher, 1);
    }
    CHECK(publisher->deadline_missed().total == 0);
    CHECK(subscription->deadline_missed().total == 0);
    CHECK(publisher->deadline_missed().next_due_ns == infinite_ns);
    CHECK(subscription->deadline_missed().next_due_ns == infinite_ns);
  }
}

TEST_CASE("a deadline is missed once per period from the first message on, on both sides") {
  Fixture f;
  const auto publisher = f.publisher(with_deadline(short_ns));
  const auto subscription = f.subscription(with_deadline(short_ns));
  const int64_t begin_ns = monotonic_ns();
  publish(*publisher, 1);
  wait_until("two misses on both sides", [&] {
    return publisher->deadline_missed().total >= 2 && subscription->deadline_missed().total >= 2;
  });
  const uint64_t before = subscription->deadline_missed().total;
  publish(*publisher, 2);
  CHECK(subscription->deadline_missed().total >= before);
  CHECK(is_soon(subscription->deadline_missed().next_due_ns, short_ns));
  CHECK(is_soon(publisher->deadline_missed().next_due_ns, short_ns));
  const uint64_t missed = subscription->deadline_missed().total;  // loaded before the clock
  CHECK(missed <= static_cast<uint64_t>((monotonic_ns() - begin_ns) / short_ns));
}

TEST_CASE("the deadline of a subscription counts messages of all its publishers, near and far") {
  Fixture f;
  const auto subscription = f.subscription(with_deadline(long_ns));
  Node far(f.platform, 2);
  far.tell("publisher /x 10+deadline");
  far.tell("matched 1");
  CHECK(subscription->deadline_missed().next_due_ns == infinite_ns);
  far.tell("publish 1 1 100");
  wait_until("the period to begin", [&] {
    return subscription->deadline_missed().next_due_ns != infinite_ns;
  });
  const int64_t first_due_ns = subscription->deadline_missed().next_due_ns;
  const auto near = f.publisher(with_deadline(long_ns));
  publish(*near, 1);
  CHECK(subscription->deadline_missed().next_due_ns > first_due_ns);
  CHECK(subscription->deadline_missed().total == 0);
}

TEST_CASE("automatic liveliness: matched is alive") {
  Fixture f;
  for (const int64_t lease : {infinite_ns, long_ns}) {
    const auto subscription = f.subscription(with_lease(lease, Liveliness::automatic));
    {
      const auto publisher = f.publisher(with_lease(lease, Liveliness::automatic));
      CHECK(subscription->liveliness().alive == 1);
      CHECK(subscription->liveliness().next_due_ns == infinite_ns);
      publisher->assert_liveliness();
      CHECK(publisher->liveliness_lost().total == 0);
    }
    CHECK(subscription->liveliness().alive == 0);
    CHECK(subscription->liveliness().not_alive == 0);
  }
}

TEST_CASE("manual liveliness: nothing before the first assertion, which may be a message") {
  Fixture f;
  const Qos qos = with_lease(long_ns, Liveliness::manual_by_topic);
  const auto subscription = f.subscription(qos);
  auto publisher = f.publisher(qos);
  CHECK(subscription->liveliness().alive == 0);
  CHECK(subscription->liveliness().not_alive == 0);
  CHECK(publisher->liveliness_lost().next_due_ns == infinite_ns);
  SUBCASE("assertion") { publisher->assert_liveliness(); }
  SUBCASE("message") { publish(*publisher, 1); }
  CHECK(subscription->liveliness().alive == 1);
  CHECK(is_soon(subscription->liveliness().next_due_ns, long_ns));
  CHECK(is_soon(publisher->liveliness_lost().next_due_ns, long_ns));
  publisher.reset();
  CHECK(subscription->liveliness().alive == 0);
  CHECK(subscription->liveliness().not_alive == 0);
}

TEST_CASE("manual liveliness: a lease that runs out is lost once, until the next assertion") {
  Fixture f;
  const Qos qos = with_lease(short_ns, Liveliness::manual_by_topic);
  const auto subscription = f.subscription(qos);
  auto publisher = f.publisher(qos);
  for (uint64_t round = 1; round <= 3; ++round) {
    publisher->assert_liveliness();
    wait_until("the lease to run out", [&] {
      return subscription->liveliness().not_alive == 1 &&
             publisher->liveliness_lost().total == round;
    });
    CHECK(subscription->liveliness().alive == 0);
    CHECK(publisher->liveliness_lost().next_due_ns == infinite_ns);
    CHECK(subscription->liveliness().next_due_ns == infinite_ns);
  }
  publisher.reset();
  CHECK(subscription->liveliness().not_alive == 0);
}

TEST_CASE("an assertion wakes only waiting threads, and only when it changes something") {
  Fixture f;
  const Qos qos = with_lease(long_ns, Liveliness::manual_by_topic);
  const auto subscription = f.subscription(qos);
  const auto publisher = f.publisher(qos);
  const auto late = f.publisher(qos);
  Waiter & waiter = f.process->waiters().common();
  const uint32_t unwatched = waiter.epoch();
  publisher->assert_liveliness();
  CHECK(waiter.epoch() == unwatched);
  f.process->waiters().event_watchers().add(common_word);
  late->assert_liveliness();
  const uint32_t woken = waiter.epoch();
  CHECK(woken != unwatched);
  late->assert_liveliness();
  CHECK(waiter.epoch() == woken);
  f.process->waiters().event_watchers().remove(common_word);
}

TEST_CASE(
  "starting a publisher's clock wakes threads of its process that sleep without a due time") {
  Fixture f;
  Waiter & waiter = f.process->waiters().common();
  f.process->waiters().event_watchers().add(common_word);
  const auto changes_epoch = [&](auto && act) {
    const uint32_t epoch = waiter.epoch();
    act();
    return waiter.epoch() != epoch;
  };
  SUBCASE("its first message, of its deadline") {
    const auto publisher = f.publisher(with_deadline(long_ns));
    CHECK(changes_epoch([&] { publish(*publisher, 1); }));
    CHECK_FALSE(changes_epoch([&] { publish(*publisher, 2); }));
  }
  SUBCASE("an assertion, and one after the lease ran out, of its lease") {
    const auto publisher = f.publisher(with_lease(short_ns, Liveliness::manual_by_topic));
    CHECK(changes_epoch([&] { publisher->assert_liveliness(); }));
    wait_until("the lease runs out", [&] { return publisher->liveliness_lost().total == 1; });
    CHECK(changes_epoch([&] { publish(*publisher, 1); }));
  }
  f.process->waiters().event_watchers().remove(common_word);
}

TEST_CASE("a killed publisher is not alive until another one is matched in its place") {
  Fixture f;
  const auto subscription = f.subscription(with_lease(long_ns, Liveliness::automatic));
  for (const uint32_t cluster : {1u, 2u}) {
    {
      Node publisher(f.platform, cluster);
      publisher.tell("publisher /x 10+lease");
      CHECK(subscription->liveliness().alive == 1);
      CHECK(subscription->liveliness().not_alive == 0);
    }
    wait_until("the death to be known", [&] { return subscription->liveliness().not_alive == 1; });
    wait_until("its match ends", [&] { return subscription->matched().current == 0; });
    f.inspection.wait_until_swept();
    CHECK(subscription->liveliness().alive == 0);
  }
}
