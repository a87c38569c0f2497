// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What subscriptions find when they look for publishers that come, close and use slots again.
#include <doctest/doctest.h>

#include "drivers_of_test.hpp"
#include "stepped_child.hpp"
#include "transport/queue/subscriber_queue.hpp"

using namespace drivers_of_test;
using manycore::Hint;

namespace {

const Role looks("looks", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto subscription = process->create_subscription(on_topic("/driver", keep_last(10)));
  begin_steps();
  take_all(*subscription);
  finish_steps();
});

}  // namespace

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

TEST_CASE("the first message of a publisher that comes in a look is taken, or waits") {
  constexpr uint64_t instructions = 1500;  // after the look has begun
  for (uint64_t after = 0; after < instructions; after += 10) {
    CAPTURE(after);
    Fixture f;
    SteppedChild reader("looks", {f.platform.name()});
    const auto known = f.publisher();  // the child has seen no change of rows when it looks
    Registry & registry = f.inspection.registry();
    const EndpointEntry & entry = registry.endpoints()[f.inspection.readers_of(*known).at(0).slot];
    auto & header = *registry.clusters().find<SubscriptionHeader>(entry.block);
    header.resync.store(1);
    while (header.resync != 0) {
      REQUIRE(reader.step(1) == 1);
    }
    reader.step(after);
    const auto publisher = f.publisher();
    publish(*publisher, 1);
    while (!reader.finished()) {
      reader.run_to_system_call();
    }
    const bool waits = header.resync != 0 || !subscriber_queue::empty(header);
    CHECK((entry.counters.messages == 1 || waits));
  }
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
