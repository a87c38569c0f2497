// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Closing endpoints, and freeing what they leave.
#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers_of_test.hpp"
#include "transport/matching/closing.hpp"
#include "transport/matching/sweeping.hpp"
#include "waiting.hpp"

using namespace drivers_of_test;

namespace {

template<typename Endpoint>
uint32_t slot_of(const Endpoint & endpoint) {
  return static_cast<uint32_t>(endpoint_in(endpoint.gid()));
}

/// Closes an endpoint as its process does, but without the sweep.
void close(Registry & registry, uint32_t slot) {
  std::vector<uint32_t> unread;
  const Registry::Lock lock(registry);
  closing::close(registry, slot, false, unread);
}

EndpointSpec replies(uint32_t depth) {
  EndpointSpec spec = on_topic("/service", keep_last(depth));
  spec.role = EndpointRole::reply;
  return spec;
}

}  // namespace

TEST_CASE("only the clients with untaken replies are asked to look when their server is closed") {
  Fixture f;
  constexpr int64_t many = 20'000;
  const auto without = f.process->create_subscription(replies(1));
  const auto deep = f.process->create_subscription(replies(many));
  const auto late = f.process->create_subscription(replies(1));
  const auto server = f.process->create_publisher(replies(1));
  for (int64_t number = 1; number <= many; ++number) {
    server->publish(server->draft(8), 8, number, {deep->gid(), number});
  }
  server->publish(server->draft(8), 8, many + 1, {late->gid(), 1});
  const auto resync_of = [&](const Subscription & subscription) -> std::atomic<uint32_t> & {
    return f.inspection.header_of(subscription).resync;
  };
  for (const auto * each : {deep.get(), late.get(), without.get()}) {
    resync_of(*each).store(0);
  }
  close(f.inspection.registry(), slot_of(*server));
  CHECK(resync_of(*deep) == 1);
  CHECK(resync_of(*late) == 1);
  CHECK(resync_of(*without) == 0);
}

TEST_CASE("a server's memory waits for the client whose reply it holds, and for no other") {
  Fixture f;
  const auto other = f.process->create_subscription(replies(1));
  const auto client = f.process->create_subscription(replies(1));
  auto server = f.process->create_publisher(replies(1));
  server->publish(server->draft(8), 8, 1, {client->gid(), 1});
  server.reset();
  CHECK(f.inspection.closing_endpoints() == 1);
  CHECK_FALSE(other->claim());
  CHECK(f.inspection.closing_endpoints() == 1);
  CHECK(client->claim());
  f.inspection.wait_until_swept();
}

TEST_CASE("many stuck subscriptions keep as many publishers as their history holds") {
  Fixture f;
  constexpr size_t many = 300;
  const auto stuck = f.subscriptions(many, keep_last(3));
  for (int i = 0; i < 20; ++i) {
    f.drive(1);
  }
  f.inspection.wait_until_swept(3);
  for (const auto & each : stuck) {
    CHECK(take_all(*each) == numbers(18, 20));
    CHECK(each->lost() == 17);
  }
  f.inspection.wait_until_swept();
}

TEST_CASE("a subscription deeper than a look, beside short-lived publishers, keeps its depth") {
  Fixture f;
  constexpr uint32_t depth = 100;
  const auto stuck = f.subscription(keep_last(depth));
  for (uint32_t i = 0; i < 3 * depth; ++i) {
    f.drive(1);
  }
  f.inspection.wait_until_swept(depth);
  CHECK(take_all(*stuck) == numbers(2 * depth + 1, 3 * depth));
  CHECK(stuck->lost() == 2 * depth);
}

TEST_CASE("a KEEP_ALL subscription keeps as many publishers as its queue holds hints") {
  Fixture f;
  const auto stuck = f.subscription(keep_all());
  for (uint32_t i = 0; i < keep_all_capacity + 50; ++i) {
    f.drive(1, 100);
  }
  f.inspection.wait_until_swept(keep_all_capacity);
  CHECK(take_all(*stuck) == numbers(51, keep_all_capacity + 50));
  CHECK(stuck->lost() == 50);
}

TEST_CASE("what subscriptions keep costs other processes nothing when the graph changes") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  const auto stuck = f.subscription(keep_last(1));
  f.drive(1);
  REQUIRE(f.inspection.closing_endpoints() == 1);
  Registry & registry = f.inspection.registry();
  const uint64_t before = registry.header().changes.load();
  f.process->create_publisher(on_topic("/other", keep_last(1)));
  // Entering the graph, closing, and freeing the endpoint: each a hold, odd and even.
  CHECK(registry.header().changes.load() - before <= 2 * 3);
}

TEST_CASE("a topic DSM goes back to its cluster and the system whole") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.publisher();
  const uint64_t resident = f.inspection.resident_bytes();
  publish(*publisher, 1, 8 * mebibyte);
  CHECK(f.inspection.resident_bytes() > resident + 7 * mebibyte);
  publisher.reset();
  f.inspection.wait_until_swept();
  CHECK(f.inspection.used_bytes() == used);
  CHECK(f.inspection.resident_bytes() <= resident);
}

TEST_CASE("the reaper is woken for what the last reader could not free, with the registry locked") {
  Fixture f;
  const auto reader = f.subscription(keep_last(1));
  f.drive(1);
  const ClusterHeader & cluster = f.inspection.registry().clusters().at(1).header();
  wait_until("the message that this process joined", [&] { return cluster.messages.load() == 1; });
  {
    const Registry::Lock lock(f.inspection.registry());
    CHECK(take_all(*reader) == numbers(1, 1));
  }
  wait_until("the wake-up of the reaper", [&] { return cluster.messages.load() == 2; });
  wait_until("the topic DSM is freed", [&] { return f.inspection.closing_endpoints() == 0; });
}

TEST_CASE(
  "the last message of a gone publisher expires: its memory goes with the look that finds it") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  Qos qos = keep_last(1);
  qos.lifespan_ns = 1;
  const auto reader = f.subscription(qos);
  {
    const auto driver = f.publisher(qos);
    publish(*driver, 1);
  }
  CHECK(f.inspection.closing_endpoints() == 1);
  CHECK_FALSE(reader->claim());
  CHECK(f.inspection.closing_endpoints() == 0);
}

TEST_CASE("a subscription that closes frees what it alone kept, however much others keep") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  const auto last_reader = f.subscription(keep_last(1));
  auto stuck = f.subscription(keep_last(10));
  std::vector<std::unique_ptr<Subscription>> readers;
  for (size_t i = 0; i < 10; ++i) {
    f.drive(1);
    const EndpointSpec spec = on_topic("/kept" + std::to_string(i), keep_last(1));
    readers.push_back(f.process->create_subscription(spec));
    publish(*f.process->create_publisher(spec), 1);
  }
  REQUIRE(f.inspection.closing_endpoints() == 10 + 10);
  stuck.reset();
  CHECK(f.inspection.closing_endpoints() == 10 + 1);  // the newest is the last reader's
  CHECK(take_all(*last_reader) == numbers(10, 10));
  CHECK(f.inspection.closing_endpoints() == 10);
}
