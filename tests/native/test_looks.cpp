// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What subscriptions find when they look for publishers that come, close and use slots again.
#include <doctest/doctest.h>

#include <atomic>
#include <thread>

#include "drivers_of_test.hpp"
#include "transport/queue/hint.hpp"
#include "waiting.hpp"

using namespace drivers_of_test;
using manycore::Hint;

TEST_CASE("history is found in a slot that was used more often than a hint can count") {
  Fixture f;
  for (uint32_t i = 0; i < Hint::incarnation_mask + 2; ++i) {
    f.publisher();
  }
  const auto publisher = f.publisher(transient_local(5));
  publish(*publisher, 1);
  const auto late = f.subscription(transient_local(5));
  CHECK(take_all(*late) == numbers(1, 1));
}

TEST_CASE("publishers that come while a subscription looks again and again lose nothing") {
  constexpr uint64_t count = 300;
  Fixture f;
  const auto subscription = f.subscription(keep_last(1000));
  SubscriptionHeader & header = f.inspection.header_of(*subscription);
  std::atomic<uint64_t> taken{0};
  std::atomic<bool> is_over{false};
  std::thread reader([&] {
    while (!is_over) {
      header.resync.store(1);
      taken += take_all(*subscription).size();
    }
  });
  std::vector<std::unique_ptr<Publisher>> publishers;  // closing asks subscriptions to look again
  while (publishers.size() < count) {
    publishers.push_back(f.publisher());
    publish(*publishers.back(), 1);
    wait_until("the message is taken or lost", [&] {
      return taken + subscription->lost() == publishers.size();
    });
  }
  is_over = true;
  reader.join();
  CHECK(subscription->lost() == 0);
}

TEST_CASE("a publisher whose history a reader took without a seat goes once it looks") {
  Fixture f;
  auto publisher = f.publisher(transient_local(5));
  publish(*publisher, 1);
  const auto reader = f.subscription(transient_local(5));
  CHECK(take_all(*reader) == numbers(1, 1));
  publisher.reset();
  reader->arrivals();
  f.inspection.wait_until_swept();
  CHECK(reader->lost() == 0);
}

TEST_CASE("the history of a publisher that closed before a subscription came is not for it") {
  Fixture f;
  const auto stuck = f.subscription(transient_local(5));
  {
    const auto gone = f.publisher(transient_local(5));
    publish(*gone, 1);
  }
  const auto publisher = f.publisher(transient_local(5));
  publish(*publisher, 2);
  const auto late = f.subscription(transient_local(5));
  CHECK(take_all(*late) == numbers(2, 2));
  CHECK(take_all(*stuck) == numbers(1, 2));
}

TEST_CASE("nothing waits for a new subscription to a history that is empty") {
  Fixture f;
  const auto publisher = f.publisher(transient_local(5));
  const auto subscription = f.subscription(transient_local(5));
  CHECK_FALSE(subscription->has_data());
  publish(*publisher, 1);
  CHECK(subscription->has_data());
}

TEST_CASE("an endpoint whose memory cannot be found leaves the chain of its topic") {
  Fixture f;
  auto damaged = f.publisher();
  const auto publisher = f.publisher();
  Registry & registry = f.inspection.registry();
  registry.endpoints()[f.inspection.slot_of(damaged->gid())].block =
    SegmentRef::make(1, uint64_t{1} << 40);
  damaged.reset();
  const auto next = f.publisher();  // in the same slot
  uint32_t rows = 0;
  registry.walk_bucket(
    registry.endpoints()[f.inspection.slot_of(next->gid())].topic_hash, [&](uint32_t, uint32_t) {
      ++rows;
      return true;
    });
  CHECK(rows == 2);
}
