// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What dead processes leave is reclaimed, and what they published before is not lost. Each test
// case kills at one significant moment; test_killed covers the moments in between.
#include <doctest/doctest.h>

#include <sys/resource.h>

#include <csignal>
#include <thread>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform/clock.hpp"
#include "survivor.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/new_endpoint.hpp"
#include "transport/topic_dsm/topic_dsm_writer.hpp"

using namespace manycore;

namespace {

/// Publishes record 1 completely, writes record 2 as far as requested, and then waits to be killed.
const Role interrupted_publisher("interrupted", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(10)));
  wait_until("a match", [&] { return publisher->matched().current == 1; });
  Registry registry(PlatformPaths::of(arguments.at(0)));
  EndpointEntry * entry = &registry.endpoints()[0];
  while (entry->gid != publisher->gid()) {
    ++entry;
  }
  TopicDsmWriter writer(registry, registry.clusters().at(1), *entry);
  writer.enter();
  const size_t size = sizeof(Payload);
  for (uint64_t number = 1; number <= 2; ++number) {
    Payload{1, number, size}.write(writer.find_room(size).data);
    if (number == 1 || arguments.at(1) == "committed") {
      writer.commit(size, realtime_ns(), number, {});
    }
  }
  test.say("interrupted");  // nothing was announced
  raise(SIGSTOP);
});

/// Closes the row of a dead process's subscription, and tells no publisher of it; then waits to be
/// killed.
const Role half_reaper("half_reaper", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const auto slot = static_cast<uint32_t>(std::stoul(arguments.at(1)));
  const Registry::Lock lock(registry);
  registry.endpoints()[slot].slot.state.store(SlotState::closed);
  test.say("half way");
  raise(SIGSTOP);
});

const Role configurator("configurator", [](Lines & test, const Arguments & arguments) {
  const Configurator keeps(arguments.at(0), host_profile(), {});
  test.say("configured");
  test.hear();
});

/// A member whose receive thread has hardly more descriptors than it needs.
const Role limited("limited", [](Lines & test, const Arguments & arguments) {
  const rlimit few{16, 16};
  require(setrlimit(RLIMIT_NOFILE, &few) == 0);
  join_and_stay(test, arguments.at(0));
});

}  // namespace

TEST_CASE("a subscriber killed while it holds a claim: its publisher goes on, its memory is free") {
  Survivor f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  const uint64_t used_with_publisher = f.inspection.used_bytes();
  {
    Node subscriber(f.platform, 1);
    subscriber.tell("subscription /x 100");
    publish(*publisher, 1);
    CHECK(subscriber.ask("claim") == "1");
  }
  f.wait_until_alone();
  CHECK(publisher->matched().current == 0);
  CHECK(f.inspection.live_endpoints() == 1);
  CHECK(f.inspection.used_bytes() == used_with_publisher);
  for (uint64_t number = 2; number <= 1000; ++number) {
    publish(*publisher, number);
  }
  CHECK(f.inspection.generations_of(*publisher) == 1);
  publisher.reset();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE(
  "a reaper killed while it closes a subscription: nothing is freed that publishers still use") {
  Survivor f;
  const auto first = f.process->create_publisher(on_topic("/x", keep_last(10)));
  const auto second = f.process->create_publisher(on_topic("/x", keep_last(10)));
  const uint64_t used = f.inspection.used_bytes();
  {
    Node subscriber(f.platform, 1);
    subscriber.tell("subscription /x 10");
    const std::string slot = std::to_string(f.inspection.registry().endpoints().high_water() - 1);
    const Standstill no_reaper(f.platform, 1);
    subscriber.kill();
    Child reaper("half_reaper", {f.platform.name(), slot});
    reaper.expect("half way");
    reaper.kill();
    f.process->create_publisher(on_topic("/y", keep_last(10)));  // repairs
    CHECK(f.inspection.closing_endpoints() == 1);
    publish(*first, 1);
    publish(*second, 1);
  }
  f.wait_until_alone();
  CHECK(f.inspection.readers_of(*first).empty());
  CHECK(f.inspection.readers_of(*second).empty());
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE(
  "a publisher killed after it wrote a record, before it announced it: the record is found") {
  Survivor f;
  const uint64_t used = f.inspection.used_bytes();
  auto subscription = f.process->create_subscription(on_topic("/x", keep_last(10)));
  SUBCASE("the second record written") {
    Child publisher("interrupted", {f.platform.name(), "committed"});
    publisher.expect("interrupted");
    CHECK_FALSE(subscription->has_data());
    publisher.kill();
    CHECK(take_next(*f.process, *subscription).number == 1);
    CHECK(take_next(*f.process, *subscription).number == 2);
  }
  SUBCASE("the second record half written: it was never there") {
    Child publisher("interrupted", {f.platform.name(), "half"});
    publisher.expect("interrupted");
    publisher.kill();
    CHECK(take_next(*f.process, *subscription).number == 1);
  }
  f.wait_until_alone();
  CHECK_FALSE(take(*subscription));
  CHECK(f.inspection.live_endpoints() == 1);
  subscription.reset();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE(
  "a subscriber killed while its publisher follows references: its memory is free once that has "
  "ended") {
  Survivor f;
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  const uint64_t used = f.inspection.used_bytes();
  Registry & registry = f.inspection.registry();
  EndpointEntry & entry = registry.endpoints()[f.inspection.slot_of(publisher->gid())];
  TopicDsmWriter writer(registry, registry.clusters().at(1), entry);
  {
    Node subscriber(f.platform, 1);
    subscriber.tell("subscription /x 100");
    writer.enter();
  }
  f.wait_until_alone(1);
  CHECK(f.inspection.live_endpoints() == 2);
  writer.leave();
  f.inspection.wait_until_swept();
  CHECK(f.inspection.used_bytes() == used);
  CHECK(f.inspection.live_endpoints() == 1);
}

TEST_CASE(
  "a receive thread killed in its phase, with the last node of its cluster: others still free") {
  Survivor f;
  {
    Node last(f.platform, 2);
    const pid_t other = f.platform.stop_receive_thread(2);
    f.inspection.registry().clusters().at(2).header().phase.fetch_or(1);  // as in forward()
    last.stop();  // it would otherwise start another one
    kill(other, SIGKILL);
    wait_until("it is killed", [&] { return !is_running(other); });
  }
  f.wait_until_alone();
  const uint64_t used = f.inspection.used_bytes();
  for (int i = 0; i < 100; ++i) {
    f.process->create_publisher(on_topic("/x", keep_last(10)));
    f.process->create_subscription(on_topic("/x", keep_last(10)));
  }
  CHECK(f.inspection.closing_endpoints() == 0);
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("a configurator killed after the last process: the platform is removed") {
  TestPlatform platform;
  Child configurator("configurator", {platform.name()});
  configurator.expect("configured");
  {
    Node node(platform, 1);
    platform.receive_thread(1);
  }
  Inspection inspection(platform);
  wait_until("the node is reaped", [&] { return inspection.live_processes() == 0; });
  CHECK(platform.exists());
  configurator.kill();
  wait_until("the platform is gone", [&] { return !platform.exists(); });
}

TEST_CASE("a reaper without descriptors left still reaps") {
  TestPlatform platform;
  Child first("limited", {platform.name()});
  first.expect("joined");
  platform.receive_thread(1);
  Inspection inspection(platform);
  std::vector<Node> nodes;
  for (int i = 0; i < 10; ++i) {  // more than the receive thread can watch
    nodes.emplace_back(platform, 1);
  }
  CHECK(inspection.live_processes() == 11);
  nodes.clear();
  wait_until("all are reaped", [&] { return inspection.live_processes() == 1; });
}

TEST_CASE("what a killed publisher published is still taken") {
  Survivor f;
  const auto subscription = f.process->create_subscription(on_topic("/x", keep_last(100)));
  Node publisher(f.platform, 2);
  publisher.tell("publisher /x 1");
  {
    // A topic DSM that cannot grow, because its publisher does not get the registry lock in time,
    // overwrites messages.
    const Standstill here(f.platform, 1);
    const Standstill there(f.platform, 2);
    publisher.tell("publish 1 50 5000");
  }
  publisher.kill();
  for (uint64_t number = 1; number <= 50; ++number) {
    REQUIRE(take_next(*f.process, *subscription).number == number);
  }
  f.wait_until_alone();
  CHECK(subscription->matched().current == 0);
}

TEST_CASE("a killed cluster, nodes and receive thread, is reaped by the others") {
  Survivor f;
  const auto subscription = f.process->create_subscription(on_topic("/x", keep_last(10)));
  {
    Node node(f.platform, 2);
    node.tell("publisher /x 1");
    const pid_t there = f.platform.receive_thread(2);
    node.stop();
    kill(there, SIGKILL);
    CHECK(subscription->matched().current == 1);
  }
  f.wait_until_alone();
  CHECK(subscription->matched().current == 0);
  Node successor(f.platform, 2);
  successor.tell("publisher /x 1");
  successor.tell("publish 1 1 100");
  CHECK(take_next(*f.process, *subscription).writer == static_cast<uint64_t>(successor.pid()));
}

TEST_CASE("killed before its cluster has a receive thread: those of other clusters reap it") {
  Survivor f;
  for (int i = 0; i < 10; ++i) {
    Node(f.platform, 2).tell("publisher /x 1");
    f.wait_until_alone();
  }
}

TEST_CASE("a receive thread that is started after all nodes died removes the platform") {
  TestPlatform platform;
  const PlatformPaths paths = platform.paths();
  pid_t dead = 0;
  {
    Node node(platform, 1);
    dead = node.pid();
    platform.receive_thread(1);
  }
  wait_until("the platform is gone", [&] { return !platform.exists(); });
  under_join_lock(paths, [&] {
    ensure_platform(paths, host_profile(), {});
    Registry registry(paths);
    Cluster::create(paths, 1, registry.header().profile, registry.nonce());
    registry.header().clusters_present = 1;
    const uint32_t slot = registry.processes().take("processes");
    registry.processes()[slot].pid = dead;
    registry.processes()[slot].cluster = 1;
    registry.processes().publish(slot);
  });
  ensure_receive_thread(Registry(paths), 1);  // ~TestPlatform waits for this
}

/// Its endpoint appears between the reaper's first look, without the lock, and its work.
TEST_CASE("a process taken for dead while it joined: what it created before its death is closed") {
  Survivor f;
  Registry & registry = f.inspection.registry();
  Node node(f.platform, 1);
  const uint32_t process = registry.processes().high_water() - 1;
  const Standstill no_other_reaper(f.platform, 1);
  node.kill();
  std::thread reaper;
  Registry seen_by_reaper(f.platform.paths());
  uint32_t endpoint = nothing;
  {
    const Registry::Lock lock(registry);
    reaper = std::thread([&] { reap_dead(seen_by_reaper, 1); });
    wait_until(
      "the reaper waits for the lock", [&] { return registry.header().mutex.is_waited_for(); });
    endpoint =
      new_endpoint(registry, on_topic("/x", keep_last(1)), EndpointKind::publisher, process);
    registry.endpoints().publish(endpoint);
    registry.link_endpoint(endpoint);
  }
  reaper.join();
  CHECK(f.inspection.live_processes() == 1);
  CHECK_FALSE(registry.endpoints().is_live(endpoint));
}

TEST_CASE("a process that cannot sweep what others left still leaves") {
  Survivor f;
  const Standstill no_other_sweeper(f.platform, 1);
  const auto stuck = f.process->create_subscription(on_topic("/stuck", keep_last(1)));
  {
    const auto gone = f.process->create_publisher(on_topic("/stuck", keep_last(1)));
    publish(*gone, 1);
  }
  Node node(f.platform, 1);
  uint32_t & cluster =
    f.inspection.registry().endpoints()[f.inspection.slot_of(stuck->gid())].cluster;
  cluster += max_clusters;
  node.say("leave");
  CHECK(node.wait() == 0);
  CHECK(f.inspection.live_processes() == 1);
  cluster -= max_clusters;
}
