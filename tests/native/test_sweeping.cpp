// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Closing and sweeping endpoints in turns, each of which goes on where the last one ended.
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

/// Returns the number of turns that it took.
size_t close(Registry & registry, uint32_t slot) {
  size_t turns = 0;
  for (bool closed = false; !closed; ++turns) {
    Turn turn;
    closed = closing::close_some(registry, slot, false, turn);
  }
  return turns;
}

/// Subscriptions of topics of their own, each with a message of a publisher that is gone.
std::vector<std::unique_ptr<Subscription>> keep_messages(
  Fixture & f, size_t count, size_t first = 0) {
  std::vector<std::unique_ptr<Subscription>> readers;
  for (size_t i = first; i < first + count; ++i) {
    const EndpointSpec spec = on_topic("/kept" + std::to_string(i), keep_last(1));
    readers.push_back(f.process->create_subscription(spec));
    publish(*f.process->create_publisher(spec), 1);
  }
  return readers;
}

/// Closed endpoints that the round in progress has passed.
size_t passed_endpoints(const RegistryHeader & header) {
  size_t passed = 0;
  header.closing.for_each([&](uint32_t slot) { passed += slot < header.sweep_from ? 1 : 0; });
  return passed;
}

}  // namespace

TEST_CASE("many readers are revoked in turns; the next sweep continues one that ended early") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 300;
  const auto stuck = f.subscriptions(many, keep_last(1));
  const auto successor = f.publisher();
  f.drive(1);
  CHECK(f.inspection.closing_endpoints() == 1);
  publish(*successor, ++f.published);
  Registry & registry = f.inspection.registry();
  const auto sweep_once = [&] {
    sweeping::Round round(registry);
    const Registry::Lock lock(registry);
    return round.sweep_some();
  };
  CHECK_FALSE(sweep_once());
  CHECK(f.inspection.closing_endpoints() == 1);
  size_t turns = 1;
  for (; f.inspection.closing_endpoints() != 0 && turns < many; ++turns) {
    sweep_once();  // as another process would, without knowledge of earlier turns
  }
  CHECK(f.inspection.closing_endpoints() == 0);
  CHECK(turns >= 4);
  for (const auto & each : stuck) {
    CHECK(take_all(*each) == numbers(2, 2));
    CHECK(each->lost() == 1);
  }
}

TEST_CASE("a server with a deep history is closed in turns, also within the look for one client") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr int64_t many = 20'000;
  constexpr size_t bystander_count = 3;
  const auto client = [&](uint32_t depth) {
    EndpointSpec spec = on_topic("/service", keep_last(depth));
    spec.role = EndpointRole::reply;
    return f.process->create_subscription(spec);
  };
  std::vector<std::unique_ptr<Subscription>> bystanders;
  for (size_t i = 0; i < bystander_count; ++i) {
    bystanders.push_back(client(1));
  }
  const auto deep = client(many);
  const auto late = client(1);
  EndpointSpec spec = on_topic("/service", keep_last(1));
  spec.role = EndpointRole::reply;
  const auto server = f.process->create_publisher(spec);
  for (int64_t number = 1; number <= many; ++number) {
    server->publish(server->draft(8), 8, number, {deep->gid(), number});
  }
  server->publish(server->draft(8), 8, many + 1, {late->gid(), 1});
  const auto resync_of = [&](const Subscription & subscription) -> std::atomic<uint32_t> & {
    return f.inspection.header_of(subscription).resync;
  };
  for (const auto * each : {deep.get(), late.get(), bystanders.front().get()}) {
    resync_of(*each).store(0);
  }
  Registry & registry = f.inspection.registry();
  const Registry::Lock lock(registry);
  const size_t turns = close(registry, slot_of(*server));
  constexpr size_t records_in_a_turn = Turn::steps * Turn::records_in_a_step;
  CHECK(turns > bystander_count * (many / records_in_a_turn));
  CHECK(resync_of(*deep) == 1);
  CHECK(resync_of(*late) == 1);
  CHECK(resync_of(*bystanders.front()) == 0);
}

TEST_CASE("a deep history is swept in turns, also within the look at one publisher") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr uint32_t depth = 20'000;
  constexpr size_t records_in_a_turn = Turn::steps * Turn::records_in_a_step;
  const auto subscription = f.subscription(keep_last(depth));
  auto former = f.publisher(keep_last(depth));
  const auto newer = f.publisher(keep_last(depth));
  for (uint32_t number = 1; number <= depth; ++number) {
    former->publish(former->draft(8), 8, number);
  }
  const auto slot = slot_of(*former);
  Registry & registry = f.inspection.registry();
  const auto turns_of_a_round = [&] {
    sweeping::Round round(registry);
    size_t turns = 1;
    for (; !round.sweep_some_of(slot); ++turns) {
    }
    return turns;
  };
  for (uint32_t number = 1; number < depth; ++number) {
    newer->publish(newer->draft(8), 8, depth + number);
  }
  former.reset();
  {
    const Registry::Lock lock(registry);
    CHECK(turns_of_a_round() > 3 * depth / records_in_a_turn);
    CHECK(f.inspection.closing_endpoints() == 1);
  }
  newer->publish(newer->draft(8), 8, 2 * depth);
  const Registry::Lock lock(registry);
  CHECK(turns_of_a_round() > 3 * depth / records_in_a_turn);
  CHECK(f.inspection.closing_endpoints() == 0);
}

TEST_CASE("a process that creates an endpoint sweeps what is behind a deep history") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr uint32_t depth = UINT16_MAX;  // takes more turns than the process has
  const auto stuck = f.subscription(keep_last(depth));
  auto former = f.publisher(keep_last(depth));
  for (uint32_t number = 1; number <= depth; ++number) {
    former->publish(former->draft(8), 8, number);
  }
  const auto slot = slot_of(*former);
  former.reset();
  const auto behind = f.process->create_publisher(on_topic("/behind", keep_last(1)));
  Registry & registry = f.inspection.registry();
  {
    const Registry::Lock lock(registry);
    close(registry, slot_of(*behind));
    registry.header().sweep_from = slot;
  }
  CHECK(f.inspection.closing_endpoints() == 2);
  f.sweep();
  CHECK(f.inspection.closing_endpoints() == 1);
}

TEST_CASE("a long look goes on although another process passes over it between its turns") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr uint32_t depth = 20'000;  // takes several turns
  const auto subscription = f.subscription(keep_last(depth));
  auto former = f.publisher(keep_last(depth));
  const auto newer = f.publisher(keep_last(depth));
  for (uint32_t number = 1; number <= depth; ++number) {
    former->publish(former->draft(8), 8, number);
  }
  for (uint32_t number = 1; number < depth; ++number) {
    newer->publish(newer->draft(8), 8, depth + number);
  }
  const auto slot = slot_of(*former);
  former.reset();
  REQUIRE(f.inspection.closing_endpoints() == 1);
  newer->publish(newer->draft(8), 8, 2 * depth);
  Registry & registry = f.inspection.registry();
  registry.header().sweep_from = slot;
  sweeping::Round round(registry);
  int turns = 0;
  for (bool over = false; !over; ++turns) {
    const Registry::Lock lock(registry);
    over = round.sweep_some();
    registry.header().sweep_from = slot + 1;  // as left by that process in the middle of its round
  }
  CHECK(turns > 4);
  CHECK(f.inspection.closing_endpoints() == 0);
}

TEST_CASE("what queues hold is found by their hints, whatever the number of publishers") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 200;
  const auto stuck = f.subscriptions(20, keep_last(1));
  const auto publishers = f.publishers(many);
  for (const auto & publisher : publishers) {
    publish(*publisher, ++f.published);
  }
  Registry & registry = f.inspection.registry();
  const auto turns_of = [&](const Publisher & publisher) {
    const auto slot = slot_of(publisher);
    const Registry::Lock lock(registry);
    close(registry, slot);
    sweeping::Round round(registry);
    int turns = 1;
    for (; !round.sweep_some_of(slot); ++turns) {
    }
    return turns;
  };
  CHECK(turns_of(*publishers[many - 1]) < 20);  // a turn is 32 steps at least
  CHECK(f.inspection.closing_endpoints() == 1);
  CHECK(turns_of(*publishers[many - 2]) < 20);  // newer than all but one, which displaced it
  CHECK(f.inspection.closing_endpoints() == 1);
  for (const auto & each : stuck) {
    CHECK(take_all(*each) == numbers(many, many));
  }
}

TEST_CASE("a turn punches one hole at most, also where a block is rounded up to pages") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t size_bytes = 12 << 10;  // with 16 descriptors: less than 16 KiB, but four pages
  const std::vector<std::unique_ptr<Publisher>> publishers = f.publishers(3);
  for (const auto & publisher : publishers) {
    publish(*publisher, 1, size_bytes);
  }
  Registry & registry = f.inspection.registry();
  const Registry::Lock lock(registry);
  for (const auto & publisher : publishers) {
    close(registry, slot_of(*publisher));
  }
  registry.header().sweep_from = 0;
  sweeping::Round round(registry);
  size_t turns = 1;
  for (; !round.sweep_some(); ++turns) {
  }
  CHECK(turns >= publishers.size());
  CHECK(f.inspection.closing_endpoints() == 0);
}

TEST_CASE("a subscription with many publishers is freed in turns") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 300;
  const auto publishers = f.publishers(many);
  const auto subscription = f.subscription(keep_last(1));
  Registry & registry = f.inspection.registry();
  const auto slot = slot_of(*subscription);
  const Registry::Lock lock(registry);
  close(registry, slot);
  CHECK_FALSE(sweeping::Round(registry).sweep_some_of(slot));
  CHECK(f.inspection.closing_endpoints() == 1);
  for (size_t turns = 1; turns < many && !sweeping::Round(registry).sweep_some_of(slot); ++turns) {
  }  // each round continues what an earlier one began
  CHECK(f.inspection.closing_endpoints() == 0);
}

TEST_CASE("a large topic DSM is freed in turns, each of which gives some of it back") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  const uint64_t used = f.inspection.used_bytes();
  const auto publisher = f.publisher();
  publish(*publisher, 1, mebibyte);
  Registry & registry = f.inspection.registry();
  const auto slot = slot_of(*publisher);
  const Registry::Lock lock(registry);
  Turn turn;
  REQUIRE(closing::close_some(registry, slot, false, turn));
  int turns = 0;
  uint64_t left = f.inspection.used_bytes();
  while (!sweeping::Round(registry).sweep_some_of(slot)) {
    REQUIRE(f.inspection.used_bytes() < left);
    left = f.inspection.used_bytes();
    ++turns;
  }
  CHECK(turns > 4);
  CHECK(f.inspection.closing_endpoints() == 0);
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("a sweep closes completely what a live process left closing") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 300;
  const auto publishers = f.publishers(many);
  const auto subscription = f.subscription(keep_last(1));
  Registry & registry = f.inspection.registry();
  {
    const Registry::Lock lock(registry);
    Turn turn;
    CHECK_FALSE(closing::close_some(registry, slot_of(*subscription), false, turn));
  }
  CHECK(f.inspection.closing_endpoints() == 1);
  sweeping::sweep_all(registry);
  CHECK(f.inspection.closing_endpoints() == 0);
  CHECK(publishers.front()->matched().current == 0);
}

TEST_CASE("readers that finished since a sweep ended early among them are checked again") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 150;
  const auto stuck = f.subscriptions(many, keep_last(1));
  const auto successor = f.publisher();
  f.drive(1);
  Registry & registry = f.inspection.registry();
  {
    const Registry::Lock lock(registry);
    REQUIRE_FALSE(sweeping::Round(registry).sweep_some());
  }
  publish(*successor, ++f.published);
  sweeping::sweep_all(registry);
  CHECK(f.inspection.closing_endpoints() == 0);
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

TEST_CASE("what subscriptions keep costs each graph change a few looks, and all is looked at") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 100;
  constexpr size_t max_looks = 16;  // a change is a creation and a destruction
  const auto readers = keep_messages(f, many);
  REQUIRE(f.inspection.closing_endpoints() == many);
  RegistryHeader & header = f.inspection.registry().header();
  header.sweep_from = 0;
  f.sweep();
  CHECK(passed_endpoints(header) > 0);
  CHECK(passed_endpoints(header) <= max_looks);
  const auto newer = f.process->create_publisher(on_topic("/kept0", keep_last(1)));
  publish(*newer, 2);  // nothing tells that the message of /kept0 is not wanted any more
  for (size_t looks = 0; looks < many; looks += max_looks / 2) {
    f.sweep();
  }
  CHECK(f.inspection.closing_endpoints() == many - 1);
}

TEST_CASE("a subscription that closes frees what it alone kept, however much others keep") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  const auto last_reader = f.subscription(keep_last(1));
  auto stuck = f.subscription(keep_last(10));
  std::vector<std::vector<std::unique_ptr<Subscription>>> readers;
  for (size_t i = 0; i < 10; ++i) {
    f.drive(1);
    readers.push_back(keep_messages(f, 20, 20 * i));
  }
  const uint32_t kept = f.inspection.closing_endpoints();
  REQUIRE(kept == 10 * 20 + 10);
  stuck.reset();
  CHECK(f.inspection.closing_endpoints() == kept - 9);  // the newest is the last reader's
  CHECK(take_all(*last_reader) == numbers(10, 10));
  CHECK(f.inspection.closing_endpoints() == kept - 10);
}
