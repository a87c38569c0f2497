// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Topic DSMs whose publishers are gone: subscriptions keep what their history holds, over all
// sources, and count the rest as lost.
#include <doctest/doctest.h>

#include <numeric>
#include <optional>

#include "messages.hpp"
#include "node_role.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/matching/closing.hpp"
#include "transport/matching/sweeping.hpp"
#include "transport/registry/odd_phase.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint64_t mebibyte = 1 << 20;

Profile profile_of(uint64_t smem_bytes) {
  Profile profile = host_profile();
  profile.smem_bytes = smem_bytes;
  return profile;
}

struct Fixture {
  std::unique_ptr<Publisher> publisher(const Qos & qos = keep_last(10)) {
    return process->create_publisher(on_topic("/driver", qos));
  }
  std::vector<std::unique_ptr<Publisher>> publishers(size_t count) {
    std::vector<std::unique_ptr<Publisher>> created;
    for (size_t i = 0; i < count; ++i) {
      created.push_back(publisher());
    }
    return created;
  }
  std::unique_ptr<Subscription> subscription(const Qos & qos) {
    return process->create_subscription(on_topic("/driver", qos));
  }
  /// Publishes `count` messages with the next numbers, and leaves.
  void drive(uint64_t count, size_t size_bytes = 1000) {
    const auto driver = publisher();
    for (uint64_t i = 0; i < count; ++i) {
      publish(*driver, ++published, size_bytes);
    }
  }
  /// Each graph change sweeps what could not be freed before.
  void sweep() { process->create_publisher(on_topic("/another", keep_last(1))); }

  TestPlatform platform;
  Configurator configurator{platform.name(), profile_of(32 * mebibyte), {}};
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  uint64_t published = 0;
};

}  // namespace

TEST_CASE(
  "a driver that restarts beside a subscription that takes nothing: no publish is refused") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  f.drive(20, 100'000);
  const uint64_t used = f.inspection.used_bytes();
  for (int i = 0; i < 200; ++i) {
    f.drive(20, 100'000);
    f.inspection.wait_until_swept(1);
  }
  CHECK(f.inspection.used_bytes() == used);
  CHECK(take_all(*stuck) == numbers(f.published - 9, f.published));
  CHECK(stuck->lost() == f.published - 10);
  f.sweep();
  f.inspection.wait_until_swept();
}

TEST_CASE("a driver that is killed again and again leaves the newest messages, and nothing else") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  for (int i = 0; i < 20; ++i) {
    Node driver(f.platform, 1);
    driver.tell("publisher /driver 10");
    driver.tell(
      "publish " + std::to_string(15 * i + 1) + " " + std::to_string(15 * i + 15) + " 100");
    driver.kill();
    wait_until("the dead driver is reaped", [&] { return f.inspection.live_processes() == 1; });
  }
  f.inspection.wait_until_swept(1);
  CHECK(take_all(*stuck) == numbers(291, 300));
  CHECK(stuck->lost() == 290);
}

TEST_CASE("the newest messages may be of many publishers") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  for (int i = 0; i < 50; ++i) {
    f.drive(1);
  }
  f.inspection.wait_until_swept(10);
  CHECK(take_all(*stuck) == numbers(41, 50));
  CHECK(stuck->lost() == 40);
  f.sweep();
  f.inspection.wait_until_swept();
}

TEST_CASE("a subscription closed while its publisher writes is freed after that") {
  Fixture f;
  const auto publisher = f.publisher();
  for (int i = 0; i < 3; ++i) {  // the reaper may not have finished its first check in the first
    auto subscription = f.subscription(keep_last(10));
    auto draft = std::make_optional(publisher->draft(sizeof(Payload)));
    subscription.reset();
    CHECK(f.inspection.closing_endpoints() == 1);
    draft.reset();
    f.inspection.wait_until_swept();
  }
}

TEST_CASE("a topic DSM taken whole while a receive thread is in its phase is freed after that") {
  Fixture f;
  f.platform.receive_thread(1);  // it resets its phase when it starts
  const auto subscription = f.subscription(keep_last(10));
  f.drive(1);
  {
    // Inside a cluster, the receive thread forwards nothing: its phase stays as it is.
    const OddPhase phase(f.inspection.registry().clusters().at(1).header().phase);
    CHECK(take_all(*subscription) == numbers(1, 1));
    CHECK(f.inspection.closing_endpoints() == 1);
  }
  f.inspection.wait_until_swept();
}

TEST_CASE("newer messages of a live publisher count as well") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(10));
  f.drive(10);
  const auto publisher = f.publisher();
  for (int i = 0; i < 9; ++i) {
    publish(*publisher, ++f.published);
  }
  f.sweep();
  f.inspection.wait_until_swept(1);
  publish(*publisher, ++f.published);
  f.sweep();
  f.inspection.wait_until_swept();
  CHECK(take_all(*stuck) == numbers(11, 20));
  CHECK(stuck->lost() == 10);
}

TEST_CASE("each subscription keeps what its own history holds") {
  Fixture f;
  const auto shallow = f.subscription(keep_last(2));
  const auto deep = f.subscription(keep_last(25));
  const auto all = f.subscription(keep_all());
  const auto quick = f.subscription(keep_last(1));
  for (int i = 0; i < 6; ++i) {
    f.drive(10);
    CHECK(take_all(*quick) == numbers(f.published, f.published));
  }
  f.inspection.wait_until_swept(6);
  CHECK(take_all(*all) == numbers(1, 60));
  f.sweep();
  f.inspection.wait_until_swept(3);
  CHECK(take_all(*deep) == numbers(36, 60));
  CHECK(take_all(*shallow) == numbers(59, 60));
  CHECK(all->lost() == 0);
  CHECK(deep->lost() == 35);
  CHECK(shallow->lost() == 58);
  CHECK(quick->lost() == 54);
}

TEST_CASE("a message that is being read when newer ones push it out stays whole until released") {
  Fixture f;
  const auto stuck = f.subscription(keep_last(2));
  f.drive(2, 5000);
  {
    const std::optional<Claim> claim = stuck->claim();
    REQUIRE(claim);
    for (int i = 0; i < 50; ++i) {
      f.drive(2, 5000);
    }
    f.inspection.wait_until_swept(2);
    CHECK(Payload::read(claim->data(), claim->size()).number == 1);
  }
  CHECK(take_all(*stuck) == numbers(101, 102));
  CHECK(stuck->lost() == 99);
  f.sweep();
  f.inspection.wait_until_swept();
}

TEST_CASE("backlogged messages that are displaced later are counted once") {
  Fixture f;
  const auto slow = f.subscription(keep_last(4));
  f.drive(4);
  CHECK(take(*slow)->number == 1);  // the others are in its backlog
  f.drive(2);
  CHECK(take(*slow)->number == 3);
  f.drive(4);
  CHECK(take_all(*slow) == numbers(7, 10));
  CHECK(slow->lost() == 4);
}

TEST_CASE("many readers are revoked in turns; the next sweep continues one that ended early") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 300;
  std::vector<std::unique_ptr<Subscription>> stuck;
  for (size_t i = 0; i < many; ++i) {
    stuck.push_back(f.subscription(keep_last(1)));
  }
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
  size_t turns = 0;
  for (bool closed = false; !closed; ++turns) {
    Turn turn;
    const auto slot = static_cast<uint32_t>(endpoint_in(server->gid()));
    closed = closing::close_some(registry, slot, false, turn);
  }
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
  const auto slot = static_cast<uint32_t>(endpoint_in(former->gid()));
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

TEST_CASE("a subscription with many publishers is freed in turns") {
  Fixture f;
  const Standstill no_other_sweeper(f.platform, 1);
  constexpr size_t many = 300;
  const auto publishers = f.publishers(many);
  const auto subscription = f.subscription(keep_last(1));
  Registry & registry = f.inspection.registry();
  const auto slot = static_cast<uint32_t>(endpoint_in(subscription->gid()));
  const Registry::Lock lock(registry);
  for (bool closed = false; !closed;) {
    Turn turn;
    closed = closing::close_some(registry, slot, false, turn);
  }
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
  const auto slot = static_cast<uint32_t>(endpoint_in(publisher->gid()));
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
    CHECK_FALSE(closing::close_some(
      registry, static_cast<uint32_t>(endpoint_in(subscription->gid())), false, turn));
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
  std::vector<std::unique_ptr<Subscription>> stuck;
  for (size_t i = 0; i < many; ++i) {
    stuck.push_back(f.subscription(keep_last(1)));
  }
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
