// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A hint is missing, as after the death of a receive thread, and `resync` is set; the next message
// arrives with its hint. The subscription must not take the next message before the missing one, at
// whatever instruction of a take both arrive. The test single-steps a process that takes in a loop,
// and lets them arrive after each number of instructions of a take.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform_of_test.hpp"
#include "stepped_child.hpp"
#include "transport/queue/subscriber_queue.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr const char * topic = "/x";

/// Tries to take without a system call until it finds a message, and reports its number.
const Role looks("looks", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto subscription = process->create_subscription(on_topic(topic, keep_last(10)));
  begin_steps();
  while (true) {
    if (const std::optional<Payload> found = take(*subscription)) {
      test.say(std::to_string(found->number));
    }
  }
});

SubscriptionHeader & subscription_of(Registry & registry) {
  for (uint32_t slot = 0; slot < registry.endpoints().high_water(); ++slot) {
    const EndpointEntry & entry = registry.endpoints()[slot];
    if (registry.endpoints().is_live(slot) && entry.kind == EndpointKind::subscription) {
      return *registry.clusters().find<SubscriptionHeader>(entry.block);
    }
  }
  throw std::runtime_error("there is no subscription");
}

uint64_t next_found(SteppedChild & subscriber) {
  while (!subscriber.lines().has_news()) {
    subscriber.run_to_system_call();
  }
  return std::stoull(subscriber.hear());
}

}  // namespace

TEST_CASE("a message whose hint is missing is not skipped for a later one") {
  const TestPlatform platform;
  const auto process = platform.join(1);
  const auto publisher = process->create_publisher(on_topic(topic, keep_last(10)));
  SteppedChild subscriber("looks", {platform.name()});
  Inspection inspection(platform);
  SubscriptionHeader & header = subscription_of(inspection.registry());
  constexpr uint64_t more_than_a_look_takes = 400;
  uint64_t number = 0;
  for (uint64_t instructions = 0; instructions < more_than_a_look_takes; ++instructions) {
    CAPTURE(instructions);
    subscriber.step(instructions);
    publish(*publisher, ++number);
    REQUIRE(subscriber_queue::pop(header));
    header.resync.store(1);
    publish(*publisher, ++number);
    REQUIRE(next_found(subscriber) == number - 1);
    REQUIRE(next_found(subscriber) == number);
  }
}
