// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A message that a KEEP_LAST 1 subscription did not take is superseded where it found a newer one
// of the same publisher, and lost otherwise.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/registry/graph.hpp"

using namespace manycore;

namespace {

/// Whose receive thread stands still, so that no sweeper comes in between.
struct Fixture {
  Fixture() : process(platform.join()), inspection(platform), standstill(platform, 1) {}

  std::unique_ptr<Publisher> publisher() {
    return process->create_publisher(on_topic("/state", keep_last(1)));
  }
  std::unique_ptr<Subscription> subscription(const Qos & qos) {
    return process->create_subscription(on_topic("/state", qos));
  }
  /// As the tools see them.
  CounterValues counters(const Subscription & subscription) {
    for (const Activity & activity : Graph(inspection.registry()).activity()) {
      if (activity.endpoint == endpoint_in(subscription.gid())) {
        return activity.counters;
      }
    }
    return {};
  }

  TestPlatform platform;
  std::shared_ptr<Process> process;
  Inspection inspection;
  Standstill standstill;
};

void publish_up_to(Publisher & publisher, uint64_t last) {
  for (uint64_t number = 1; number <= last; ++number) {
    publish(publisher, number);
  }
}

}  // namespace

TEST_CASE("what a newer message replaced is superseded, before and after the take") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto newest = f.subscription(keep_last(1));
  publish_up_to(*publisher, 10);
  CHECK(f.counters(*newest).superseded == 9);
  CHECK(take_all(*newest) == numbers(10, 10));
  const CounterValues counters = f.counters(*newest);
  CHECK(counters.superseded == 9);
  CHECK(counters.lost == 0);
  CHECK(newest->superseded() == 9);
  CHECK(newest->lost() == 0);
}

TEST_CASE("a deeper history, and one of requests, loses what overflows") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto deeper = f.subscription(keep_last(2));
  EndpointSpec requests = on_topic("/service", keep_last(1));
  requests.role = EndpointRole::request;
  const auto client = f.process->create_publisher(requests);
  const auto server = f.process->create_subscription(requests);
  publish_up_to(*publisher, 10);
  publish_up_to(*client, 10);
  take_all(*deeper);
  take_all(*server);
  CHECK(deeper->lost() == 8);
  CHECK(deeper->superseded() == 0);
  CHECK(server->lost() == 9);
  CHECK(server->superseded() == 0);
}

TEST_CASE("a message of another publisher is no replacement: in the end the last one is lost") {
  Fixture f;
  const auto one = f.publisher();
  const auto other = f.publisher();
  const auto newest = f.subscription(keep_last(1));
  publish(*one, 1);
  publish(*other, 2);
  CHECK(take_all(*newest) == numbers(2, 2));
  CHECK(newest->lost() == 1);
  CHECK(newest->superseded() == 0);
}

TEST_CASE("an unreadable message is lost") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto newest = f.subscription(keep_last(1));
  publish(*publisher, 1);
  newest->claim()->reject();
  CHECK(newest->lost() == 1);
  CHECK(newest->superseded() == 0);
}

TEST_CASE("a message whose room a newer one is written into is superseded") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto newest = f.subscription(keep_last(1));
  publish(*publisher, 1);
  Draft draft = publisher->draft(sizeof(Payload));
  CHECK(take_all(*newest).empty());
  CHECK(newest->lost() == 0);
  Payload{1, 2, sizeof(Payload)}.write(draft.data());
  publisher->publish(std::move(draft), sizeof(Payload), realtime_ns());
  CHECK(take_all(*newest) == numbers(2, 2));
  CHECK(newest->superseded() == 1);
  CHECK(newest->lost() == 0);
}

TEST_CASE("a message whose replacement is given up is lost") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto newest = f.subscription(keep_last(1));
  publish(*publisher, 1);
  {
    const Draft draft = publisher->draft(sizeof(Payload));
    CHECK(take_all(*newest).empty());
  }
  CHECK(take_all(*newest).empty());
  CHECK(newest->lost() == 1);
  CHECK(newest->superseded() == 0);
}
