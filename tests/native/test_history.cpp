// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What a late joiner receives, and what KEEP_ALL guarantees.
#include <doctest/doctest.h>

#include <future>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

struct Fixture {
  TestPlatform platform;
  Configurator configurator{platform.name(), host_profile(), {{"/fixed", 1, 1024, 0}}};
  std::shared_ptr<Process> process = platform.join();
  Standstill receive_thread{platform, 1};

  std::unique_ptr<Publisher> publisher(const Qos & qos, const std::string & topic = "/history") {
    return process->create_publisher(on_topic(topic, qos));
  }
  std::unique_ptr<Subscription> subscription(
    const Qos & qos, const std::string & topic = "/history") {
    return process->create_subscription(on_topic(topic, qos));
  }
};

}  // namespace

TEST_CASE("volatile: a late joiner gets messages published from then on") {
  Fixture f;
  const auto publisher = f.publisher(transient_local(10));
  publish(*publisher, 1);
  const auto late = f.subscription(keep_last(10));
  CHECK_FALSE(late->has_data());
  publish(*publisher, 2);
  CHECK(take_all(*late) == numbers(2, 2));
}

TEST_CASE("transient local: a late joiner gets the last messages in order, then the new ones") {
  Fixture f;
  const auto publisher = f.publisher(transient_local(5));
  for (uint64_t number = 1; number <= 20; ++number) {
    publish(*publisher, number, 300);
  }
  const auto late = f.subscription(transient_local(10));
  CHECK(late->has_data());
  publish(*publisher, 21);
  CHECK(take_all(*late) == numbers(16, 21));
  CHECK(late->lost() == 0);
}

TEST_CASE("transient local: history is cut to the depth of the subscription") {
  Fixture f;
  const auto publisher = f.publisher(transient_local(10));
  for (uint64_t number = 1; number <= 20; ++number) {
    publish(*publisher, number);
  }
  CHECK(take_all(*f.subscription(transient_local(3))) == numbers(18, 20));
  CHECK(take_all(*f.subscription(transient_local(1))) == numbers(20, 20));
}

TEST_CASE("transient local: history survives that others took it, and growth") {
  Fixture f;
  const auto publisher = f.publisher(transient_local(1000));
  const auto early = f.subscription(keep_last(1000));
  for (uint64_t number = 1; number <= 1500; ++number) {
    publish(*publisher, number, 40 + number % 5 * 100);
  }
  CHECK(take_all(*early) == numbers(501, 1500));
  CHECK(take_all(*f.subscription(transient_local(1000))) == numbers(501, 1500));
}

TEST_CASE("transient local + KEEP_ALL: a late joiner gets all, whatever the depth says") {
  Fixture f;
  Qos qos = keep_all();
  qos.durability = Durability::transient_local;
  qos.depth = 1;
  const auto publisher = f.publisher(qos);
  for (uint64_t number = 1; number <= 500; ++number) {
    publish(*publisher, number);
  }
  CHECK(take_all(*f.subscription(qos)) == numbers(1, 500));
  CHECK(take_all(*f.subscription(transient_local(10))) == numbers(491, 500));
}

TEST_CASE("transient local: histories of several publishers are merged by time") {
  Fixture f;
  const auto first = f.publisher(transient_local(10));
  const auto second = f.publisher(transient_local(10));
  publish(*first, 1);
  publish(*second, 2);
  publish(*first, 3);
  publish(*second, 4);
  CHECK(take_all(*f.subscription(transient_local(10))) == numbers(1, 4));
  CHECK(take_all(*f.subscription(transient_local(3))) == numbers(2, 4));
}

TEST_CASE("RELIABLE + KEEP_ALL: a full topic DSM refuses with a timeout, and loses nothing") {
  Fixture f;
  const auto publisher = f.publisher(keep_all(), "/fixed");
  const auto subscription = f.subscription(keep_all(), "/fixed");
  uint64_t last = 0;
  const Refusal refusal = refusal_of([&] {
    for (uint64_t number = 1; number <= 1000; ++number) {
      publish(*publisher, number, 100);
      last = number;
    }
  });
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK(refusal.says("/fixed"));
  REQUIRE(last >= 4);
  CHECK(take(*subscription)->number == 1);
  publish(*publisher, last + 1, 100);  // as much room as was freed
  CHECK(take_all(*subscription) == numbers(2, last + 1));
  CHECK(subscription->lost() == 0);
}

TEST_CASE("RELIABLE + KEEP_ALL: a waiting publisher continues as soon as there is room") {
  // Cannot prove that no wake-up is ever lost: most lost wake-ups show as a timeout of publish().
  Fixture f;
  constexpr uint64_t count = 3000;
  const auto publisher = f.publisher(keep_all(), "/fixed");
  const auto subscription = f.subscription(keep_all(), "/fixed");
  auto receiver = std::async(std::launch::async, [&] {
    for (uint64_t number = 1; number <= count; ++number) {
      REQUIRE(take_next(*f.process, *subscription).number == number);
    }
  });
  for (uint64_t number = 1; number <= count; ++number) {
    Refusal refusal{ErrorCode::timeout, ""};
    while (refusal.code == ErrorCode::timeout) {  // on a loaded machine
      refusal = refusal_of([&] { publish(*publisher, number, 100); });
    }
    REQUIRE(refusal.text == "");
  }
  receiver.get();
}

TEST_CASE("RELIABLE + KEEP_ALL: a reader that is closed lets the publisher continue") {
  Fixture f;
  const auto publisher = f.publisher(keep_all(), "/fixed");
  auto subscription = f.subscription(keep_all(), "/fixed");
  while (!refusal_of([&] { publish(*publisher, 1, 100); }).code) {
  }
  subscription.reset();
  for (uint64_t number = 1; number <= 100; ++number) {
    publish(*publisher, number, 100);
  }
}

TEST_CASE("an expired message is deleted: its room is free although it was not taken") {
  Fixture f;
  Qos qos = keep_all();
  qos.durability = Durability::transient_local;
  qos.lifespan_ns = 3600 * ns_per_s;
  const auto publisher = f.publisher(qos, "/fixed");
  const auto subscription = f.subscription(keep_all(), "/fixed");
  const int64_t expired_ns = realtime_ns() - 2 * qos.lifespan_ns;
  for (int i = 0; i < 1000; ++i) {  // far more than fit
    publisher->publish(publisher->draft(100), 100, expired_ns);
  }
  publish(*publisher, 1, 100);
  CHECK(take(*subscription)->number == 1);
}

TEST_CASE("arrivals never decrease: hints of expired messages do not offset later messages") {
  Fixture f;
  Qos qos = keep_last(10);
  qos.lifespan_ns = 3600 * ns_per_s;
  const auto subscription = f.subscription(keep_last(100));
  const auto publisher = f.publisher(qos);
  for (int i = 0; i < 5; ++i) {
    publisher->publish(publisher->draft(100), 100, realtime_ns() - 2 * qos.lifespan_ns);
  }
  publish(*publisher, 1);
  const auto other = f.publisher(keep_last(10));
  publish(*other, 2);
  const uint64_t before = subscription->arrivals();
  CHECK(take_all(*subscription).size() == 2);  // finds the new source, and scans all of them
  CHECK(subscription->arrivals() == before);
  publish(*other, 3);
  CHECK(subscription->arrivals() == before + 1);
}

TEST_CASE("KEEP_ALL holds more messages than the queue holds hints") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(1));
  const auto subscription = f.subscription(keep_all());
  for (uint64_t number = 1; number <= 3000; ++number) {
    publish(*publisher, number);
  }
  CHECK(take_all(*subscription) == numbers(1, 3000));
  publish(*publisher, 3001);
  CHECK(take_all(*subscription) == numbers(3001, 3001));
}

TEST_CASE("BEST_EFFORT + KEEP_ALL never waits") {
  Fixture f;
  Qos qos = keep_all();
  qos.reliability = Reliability::best_effort;
  const auto publisher = f.publisher(qos, "/fixed");
  const auto subscription = f.subscription(qos, "/fixed");
  for (uint64_t number = 1; number <= 1000; ++number) {
    publish(*publisher, number, 100);
  }
  const std::vector<uint64_t> taken = take_all(*subscription);
  CHECK(taken == numbers(1001 - taken.size(), 1000));
  CHECK(taken.size() + subscription->lost() == 1000);
}
