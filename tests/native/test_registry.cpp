// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Tables and lock of the registry.
#include <doctest/doctest.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>

#include "child.hpp"
#include "messages.hpp"
#include "node_role.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/registry/smem_charge.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

/// Holds the registry lock of a platform, and half a change, until it is killed.
const Role lock_holder("lock_holder", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const Registry::Lock lock(registry);
  // As if creating endpoints was interrupted: slots and SMEM without references ..
  registry.endpoints().take("endpoints");
  registry.nodes().take("nodes");
  registry.clusters().at(1).allocate(1 << 20);
  // .. and broken chains.
  for (TopicBucket & bucket : registry.header().topic_buckets) {
    bucket.first = nothing;
  }
  test.say("holding");
  raise(SIGSTOP);
});

/// Holds the registry lock of a platform until it is told to end; runs meanwhile.
const Role busy_owner("busy_owner", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const Registry::Lock lock(registry);
  test.say("holding");
  test.expect("end");
});

struct Fixture {
  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  Registry & registry = inspection.registry();
};

}  // namespace

TEST_CASE("slots of endpoints and nodes are used again, and never with the same gid") {
  Fixture f;
  std::set<Gid> gids;
  for (int i = 0; i < 200; ++i) {
    const auto publisher = f.process->create_publisher(on_topic("/reuse", keep_last(1)));
    const auto subscription = f.process->create_subscription(on_topic("/reuse", keep_last(1)));
    gids.insert(publisher->gid());
    gids.insert(subscription->gid());
    f.process->remove_node(f.process->add_node("node", "/", "/"));
  }
  CHECK(gids.size() == 400);
  CHECK(f.registry.endpoints().high_water() == 2);
  CHECK(f.registry.nodes().high_water() == 1);
}

TEST_CASE("names that do not fit are refused with their limit, and cost no slot") {
  Fixture f;
  const std::string longest(255, 'x');
  const std::string too_long(256, 'x');
  f.process->remove_node(f.process->add_node(longest, longest, longest));
  const auto bad_name = refusal_of([&] { f.process->add_node(too_long, "/", "/"); });
  CHECK(bad_name.code == ErrorCode::invalid_argument);
  CHECK(bad_name.says("node name"));
  CHECK(bad_name.says("255 characters"));
  CHECK(refusal_of([&] { f.process->add_node("x", too_long, "/"); }).says("namespace"));
  CHECK(refusal_of([&] { f.process->add_node("x", "/", too_long); }).says("enclave"));
  const EndpointSpec fits = on_topic(longest, keep_last(1));
  f.process->create_publisher(fits);
  EndpointSpec topic = on_topic(too_long, keep_last(1));
  CHECK(refusal_of([&] { f.process->create_publisher(topic); }).says("topic"));
  EndpointSpec type = fits;
  type.type = too_long;
  CHECK(refusal_of([&] { f.process->create_subscription(type); }).says("type"));
  CHECK(f.process->graph().nodes().empty());
  CHECK(f.inspection.live_endpoints() == 0);
  CHECK(f.registry.endpoints().high_water() == 1);
}

TEST_CASE("a full table reports its name and size; a freed slot can be used again") {
  Fixture f;
  std::vector<uint32_t> nodes;
  for (uint32_t i = 0; i < node_capacity; ++i) {
    nodes.push_back(f.process->add_node("node", "/", "/"));
  }
  const Refusal refusal = refusal_of([&] { f.process->add_node("one_more", "/", "/"); });
  CHECK(refusal.code == ErrorCode::no_space);
  CHECK(refusal.says("table of nodes is full (4096)"));
  f.process->remove_node(nodes[7]);
  CHECK(f.process->add_node("one_more", "/", "/") == nodes[7]);
}

TEST_CASE("topics that share a bucket are distinguished") {
  Fixture f;
  // The first two names whose hashes share a bucket.
  std::map<uint64_t, std::string> names;
  std::string first;
  std::string second;
  for (int i = 0; second.empty(); ++i) {
    const std::string name = "/t" + std::to_string(i);
    const auto [known, is_new] = names.emplace(hash_name(name.c_str()) % topic_bucket_count, name);
    if (!is_new) {
      first = known->second;
      second = name;
    }
  }
  const auto one = f.process->create_publisher(on_topic(first, keep_last(1)));
  auto other = f.process->create_publisher(on_topic(second, keep_last(1)));
  const auto subscription = f.process->create_subscription(on_topic(first, keep_last(10)));
  publish(*one, 1);
  publish(*other, 2);
  CHECK(take_all(*subscription) == numbers(1, 1));
  CHECK(f.process->graph().endpoints_of(first).size() == 2);
  CHECK(f.process->graph().endpoints_of(second).size() == 1);
  other.reset();
  CHECK(f.process->graph().endpoints_of(first).size() == 2);
}

TEST_CASE("the topic table is found by name") {
  TestPlatform platform;
  const Configurator configurator(
    platform.name(), host_profile(), {{"/a", 1, 64, 1}, {"/b", 2, 0, 3}});
  Registry registry(platform.paths());
  CHECK(registry.find_topic("/a")->topic_dsm_size == 64);
  CHECK(registry.find_topic("/b")->topic_id == 2);
  CHECK(registry.find_topic("/b")->receiver_clusters == 3);
  CHECK(registry.find_topic("/c") == nullptr);
}

TEST_CASE("the topic table holds as many topics as it says, and refuses more") {
  for (const bool fits : {true, false}) {
    CAPTURE(fits);
    TestPlatform platform;
    std::vector<TopicConfiguration> topics;
    for (uint32_t id = 0; id < topic_capacity + (fits ? 0 : 1); ++id) {
      topics.push_back({"/topic_" + std::to_string(id), id, 4096, 0});
    }
    const Refusal refusal = refusal_of([&] {
      const Configurator configurator(platform.name(), host_profile(), topics);
      const auto process = platform.join();
      process->create_publisher(on_topic("/topic_4095", keep_last(1)));
    });
    CHECK(refusal.says(fits ? "" : "room for 4096"));
    CHECK(refusal.code.has_value() != fits);
  }
}

TEST_CASE("killed while it holds the lock: the next owner repairs incomplete changes") {
  // One state in which the owner may die. All instructions of a change: test_killed.
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/repair", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/repair", keep_last(10)));
  const uint64_t used = f.inspection.used_bytes();
  Child holder("lock_holder", {f.platform.name()});
  holder.expect("holding");
  CHECK(f.inspection.used_bytes() > used);
  holder.kill();
  CHECK(f.process->graph().endpoints_of("/repair").size() == 2);  // without the chains
  { const Registry::Lock repairs(f.registry); }
  CHECK(f.process->graph().endpoints_of("/repair").size() == 2);
  CHECK(f.inspection.used_bytes() == used);
  CHECK(publisher->matched().current == 1);
  CHECK(subscription->matched().current == 1);
  const auto late = f.process->create_subscription(on_topic("/repair", keep_last(10)));
  CHECK(late->matched().current == 1);
  CHECK(f.process->add_node("node", "/", "/") == 0);
  CHECK(f.registry.endpoints().high_water() == 3);
  publish(*publisher, 1, 10'000);
  CHECK(take_all(*subscription) == numbers(1, 1));
  CHECK(take_all(*late) == numbers(1, 1));
}

TEST_CASE("killed while it holds the lock: a process that can map no cluster leaves the repair") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/repair", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/repair", keep_last(10)));
  const uint64_t used = f.inspection.used_bytes();
  const Standstill reaper(f.platform, 1);  // it would repair as well
  Child holder("lock_holder", {f.platform.name()});
  holder.expect("holding");
  holder.kill();
  Registry late(f.platform.paths());
  late.use_badge_of(
    process_of(late, ProcessIdentity::own()));  // a guest needs a descriptor to lock
  for (int i = 0; i < 2; ++i) {                 // the second time the owner has not just died
    const Refusal refusal = refusal_of([&] {
      const NoDescriptors none;
      const Registry::Lock lock(late);
    });
    CHECK(refusal.code == ErrorCode::system);
    CHECK_MESSAGE(refusal.says("this process cannot map cluster 1"), refusal.text);
    CHECK_MESSAGE(refusal.says("ulimit -n"), refusal.text);
    CHECK(f.inspection.used_bytes() > used);
    CHECK(f.process->graph().endpoints_of("/repair").size() == 2);  // without the chains
  }
  { const Registry::Lock repairs(late); }
  CHECK(f.inspection.used_bytes() == used);
  CHECK(f.registry.header().changes.load() % 2 == 0);
  const auto second = f.process->create_subscription(on_topic("/repair", keep_last(10)));
  CHECK(second->matched().current == 1);
  CHECK(f.registry.endpoints().high_water() == 3);
}

TEST_CASE("memory outside the segment counts as SMEM, up to the limit") {
  Fixture f;
  Registry & registry = f.inspection.registry();
  const Cluster & cluster = registry.clusters().at(1);
  const uint64_t used = cluster.used_bytes();
  const uint64_t most = cluster.size() - used - control_reserve_bytes(cluster.size());
  charge_smem(registry, ProcessIdentity::own(), 1000);
  CHECK(cluster.used_bytes() == used + 1000);
  const Refusal refusal =
    refusal_of([&] { charge_smem(registry, ProcessIdentity::own(), most + 1); });
  CHECK(refusal.code == ErrorCode::no_space);
  CHECK(refusal.says("raise smem_size"));
  CHECK(cluster.used_bytes() == used + 1000);
  SUBCASE("what is charged cannot be allocated") {
    charge_smem(registry, ProcessIdentity::own(), most - 100'000);
    CHECK(f.process->graph().clusters().at(0).charged_bytes == most - 100'000);
    const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
    const Refusal full = refusal_of([&] { publish(*publisher, 1, 100'000); });
    CHECK(full.says("has no room for"));
    charge_smem(registry, ProcessIdentity::own(), 0);
    CHECK_NOTHROW(publish(*publisher, 1, 100'000));
  }
  SUBCASE("a repair finds it again") {
    Child holder("lock_holder", {f.platform.name()});
    holder.expect("holding");
    cluster.header().charged_bytes.store(5);  // as an interrupted change may leave it
    holder.kill();
    { const Registry::Lock repairs(registry); }
    CHECK(cluster.used_bytes() == used + 1000);
  }
  SUBCASE("a process that leaves frees it") {
    f.process.reset();
    CHECK(cluster.header().charged_bytes.load() == 0);
    CHECK(refusal_of([&] {
            charge_smem(registry, ProcessIdentity::own(), 1);
          }).says("is not on the platform"));
  }
}

TEST_CASE("the lock of a stopped owner is waited for, then an error says so") {
  Fixture f;
  Child holder("lock_holder", {f.platform.name()});
  holder.expect("holding");
  holder.wait_until_stopped();
  const Refusal refusal =
    refusal_of([&] { const Registry::Lock lock(f.registry, Registry::Lock::short_wait_ns); });
  CHECK(refusal.code == ErrorCode::timeout);
  const std::string pid = std::to_string(holder.pid());
  CHECK_MESSAGE(refusal.says("process " + pid + " ("), refusal.text);
  const std::string advice = "kill -CONT " + pid;
  CHECK_MESSAGE(refusal.says("is stopped; continue it (`" + advice + "`)"), refusal.text);
  REQUIRE(std::system(advice.c_str()) == 0);
  CHECK(holder.wait() == 0);  // its end has released the lock
  CHECK(f.process->graph().nodes().empty());
}

TEST_CASE("the lock of a running owner: the error does not call it stopped") {
  Fixture f;
  Child owner("busy_owner", {f.platform.name()});
  owner.expect("holding");
  const Refusal refusal =
    refusal_of([&] { const Registry::Lock lock(f.registry, Registry::Lock::short_wait_ns); });
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK_MESSAGE(refusal.says("process " + std::to_string(owner.pid())), refusal.text);
  CHECK_MESSAGE(refusal.says("is not stopped"), refusal.text);
  owner.say("end");
  CHECK(owner.wait() == 0);
}

TEST_CASE("a damaged lock that names no seat is taken over, and the registry is repaired") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(1)));
  const Standstill receive_thread(f.platform, 1);  // it would take the lock over as well
  constexpr uint64_t no_seat = UINT64_MAX;
  std::memcpy(static_cast<void *>(&f.registry.header().mutex), &no_seat, sizeof no_seat);
  f.registry.header().topic_buckets[hash_name("/x") % topic_bucket_count].first = nothing;
  { const Registry::Lock lock(f.registry, Registry::Lock::short_wait_ns); }
  CHECK(f.process->graph().endpoints_of("/x").size() == 1);
  CHECK_FALSE(f.registry.header().mutex.owner());
}

TEST_CASE("a damaged lock that names a living process is not taken over; the error says so") {
  Fixture f;
  const Standstill receive_thread(f.platform, 1);  // it would wait for the lock as well
  Registry guest(f.platform.paths());
  constexpr uint64_t of_slot_0 = 1 << 12 | 1 << 1;
  constexpr uint64_t unlocked = 0;
  std::memcpy(static_cast<void *>(&f.registry.header().mutex), &of_slot_0, sizeof of_slot_0);
  REQUIRE(f.registry.header().mutex.owner() == 0);
  const Refusal refusal =
    refusal_of([&] { const Registry::Lock lock(guest, Registry::Lock::short_wait_ns); });
  std::memcpy(static_cast<void *>(&f.registry.header().mutex), &unlocked, sizeof unlocked);
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK_MESSAGE(refusal.says("registry stayed locked"), refusal.text);
  CHECK_MESSAGE(refusal.says("run 'manycore clean'"), refusal.text);
}

TEST_CASE("the error of a lock that is only tried does not describe its owner") {
  Fixture f;
  Child owner("busy_owner", {f.platform.name()});
  owner.expect("holding");
  const Refusal refusal =
    refusal_of([&] { const Registry::Lock lock(f.registry, Registry::Lock::no_wait_ns); });
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK(refusal.text == "the platform's registry is locked");
  owner.say("end");
  CHECK(owner.wait() == 0);
}

TEST_CASE("an endpoint whose closing did not get the lock is closed with its process") {
  Fixture f;
  const Node other(f.platform, 1);
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.process->create_publisher(on_topic("/x", keep_last(1)));
  {
    Child owner("busy_owner", {f.platform.name()});
    owner.expect("holding");
    publisher.reset();
    owner.say("end");
    CHECK(owner.wait() == 0);
  }
  CHECK(f.inspection.live_endpoints() == 1);
  f.process.reset();
  f.inspection.wait_until_swept();
  CHECK(f.inspection.live_endpoints() == 0);
  CHECK(f.inspection.used_bytes() == used);
}
