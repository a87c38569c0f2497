// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Blocks in the hand of a process, which backs and frees them without the registry lock: landings,
// large blocks of seats, large queues, and the blocks of closed endpoints.
#include <doctest/doctest.h>

#include <sys/mount.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <future>
#include <vector>

#include "private_shm.hpp"
#include "stepped_child.hpp"
#include "transfer_of_test.hpp"
#include "transport/registry/block_in_hand.hpp"

using namespace manycore;
using transfer_of_test::by;
using transfer_of_test::dsm_bytes;

namespace {

void subscribe_by_steps(const Arguments & arguments, uint32_t depth) {
  const auto process =
    join_platform(arguments.at(0), static_cast<uint32_t>(std::stoul(arguments.at(1))));
  begin_steps();
  const auto subscription = process->create_subscription(on_topic("/x", keep_last(depth)));
  finish_steps();
}

/// Publishes to more subscriptions than it has seats for.
const Role addresses("addresses", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
  begin_steps();
  publish(*publisher, 1);
  finish_steps();
});

const Role subscribes("subscribes", [](Lines &, const Arguments & arguments) {
  subscribe_by_steps(arguments, 1);
});

constexpr uint32_t deep = 65'535;
constexpr uint64_t deep_bytes = 512 << 10;  ///< of its queue

const Role subscribes_deep("subscribes_deep", [](Lines &, const Arguments & arguments) {
  subscribe_by_steps(arguments, deep);
});

bool is_any_in_hand(Registry & registry) {
  const auto & hands = registry.header().hands;
  return std::any_of(
    std::begin(hands), std::end(hands), [](const Hand & hand) { return hand.block.load() != 0; });
}

Profile profile_of(uint64_t smem_bytes) {
  Profile profile = host_profile();
  profile.smem_bytes = smem_bytes;
  return profile;
}

/// Memory added to the segment of a cluster while a child creates an endpoint.
struct Backed {
  uint64_t without_lock = 0;
  uint64_t in_longest_hold = 0;  ///< in one hold of the registry lock, the largest
};

Backed run_to_end(SteppedChild & child, Inspection & inspection, uint32_t cluster) {
  const RegistryHeader & header = inspection.registry().header();
  Backed backed;
  uint64_t in_hold = 0;
  uint64_t hold = 0;
  for (uint64_t before = inspection.resident_bytes(cluster); !child.finished();) {
    const uint64_t changes = header.changes.load();
    in_hold = changes == hold ? in_hold : 0;
    hold = changes;
    child.run_to_system_call();
    const uint64_t now = inspection.resident_bytes(cluster);
    const uint64_t more = now - std::min(now, before);
    before = now;
    const bool was_locked = changes % 2 != 0 && header.changes.load() == changes;
    in_hold += was_locked ? more : 0;
    backed.without_lock += was_locked ? 0 : more;
    backed.in_longest_hold = std::max(backed.in_longest_hold, in_hold);
  }
  return backed;
}

/// As many subscriptions of a topic as fill the small blocks of a publisher's table of seats.
struct Crowd {
  Crowd() {
    while (subscriptions.size() < 500) {
      subscriptions.push_back(process->create_subscription(on_topic("/x", keep_last(1))));
    }
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  std::vector<std::unique_ptr<Subscription>> subscriptions;
};

/// A publisher in cluster 1, and subscriptions in cluster 2.
struct FromAfar {
  explicit FromAfar(const Profile & profile_ = host_profile()) : profile(profile_) {
    publisher.tell("publisher /x 1");
  }
  std::unique_ptr<Subscription> subscription() const {
    return process->create_subscription(on_topic("/x", keep_last(1)));
  }

  const Profile profile;
  TestPlatform platform;
  Configurator configurator{
    platform.name(), profile, {{"/x", 1, dsm_bytes, 0, by(Transfer::async)}}};
  Node publisher{platform, 1};
  std::shared_ptr<Process> process = platform.join(2);
  Inspection inspection{platform};
};

}  // namespace

TEST_CASE("a landing is backed with memory without the registry lock") {
  FromAfar f;
  SteppedChild child("subscribes", {f.platform.name(), "2"});
  const Backed backed = run_to_end(child, f.inspection, 2);
  CHECK(backed.without_lock >= dsm_bytes);
  CHECK(backed.in_longest_hold == 0);
}

TEST_CASE("a block of seats, small or large, is backed with memory without the registry lock") {
  Crowd f;
  SteppedChild child("addresses", {f.platform.name()});
  const Backed backed = run_to_end(child, f.inspection, 1);
  CHECK(take(*f.subscriptions.back()));
  CHECK(backed.in_longest_hold == 0);
}

TEST_CASE("a large queue is backed with memory without the registry lock, and given back so") {
  TestPlatform platform;
  const auto process = platform.join();
  Inspection inspection(platform);
  const uint64_t used = inspection.used_bytes();
  const uint64_t resident = inspection.resident_bytes();
  {
    SteppedChild child("subscribes_deep", {platform.name(), "1"});
    const Backed backed = run_to_end(child, inspection, 1);
    CHECK(backed.without_lock >= deep_bytes);
    CHECK(backed.in_longest_hold == 0);
    CHECK_FALSE(is_any_in_hand(inspection.registry()));
    child.kill();
  }
  wait_until("it is reaped", [&] { return inspection.used_bytes() == used; });
  CHECK(inspection.resident_bytes() < resident + deep_bytes);
}

TEST_CASE("a hand that its process could not empty is emptied by its next use") {
  const TestPlatform platform;
  const auto process = platform.join();
  Inspection inspection(platform);
  Registry & registry = inspection.registry();
  const uint64_t used = inspection.used_bytes();
  {
    BlockInHand hand(registry, Registry::Lock::no_wait_ns);
    const Registry::Lock lock(registry);
    Cluster & cluster = registry.clusters().at(1);
    hand.take_up(SegmentRef::make(1, cluster.allocate(deep_bytes)), deep_bytes);
  }
  CHECK_FALSE(is_any_in_hand(registry));
  CHECK(inspection.used_bytes() == used);
  {
    std::optional<Registry::Lock> lock;
    BlockInHand hand(registry, Registry::Lock::no_wait_ns);
    lock.emplace(registry);
    hand.take_up(SegmentRef::make(1, registry.clusters().at(1).allocate(deep_bytes)), deep_bytes);
    std::async(std::launch::async, [gone = std::move(hand)] {}).get();  // while the lock is held
  }
  CHECK(is_any_in_hand(registry));
  CHECK(inspection.used_bytes() == used + deep_bytes);
  const BlockInHand next(registry);
  CHECK(inspection.used_bytes() == used);
}

TEST_CASE("a block that changes hands when its process dies has one owner after the repair") {
  const TestPlatform platform;
  const auto process = platform.join();
  Inspection inspection(platform);
  Registry & registry = inspection.registry();
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
  publish(*publisher, 1, 60'000);
  const uint64_t used = inspection.used_bytes();
  Hand & hand = *registry.own_hand();
  for (const GenerationEntry & entry : inspection.header_of(*publisher).generations) {
    if (entry.offset.load() != 0 && entry.extent_bytes() > 60'000) {
      hand.bytes.store(entry.extent_bytes());
      hand.block.store(SegmentRef::make(1, entry.offset.load()).word);
    }
  }
  REQUIRE(is_any_in_hand(registry));
  registry.header().needs_repair = 1;
  process->add_node("node", "/", "/");
  CHECK_FALSE(is_any_in_hand(registry));
  CHECK(inspection.used_bytes() == used);
}

TEST_CASE("a process that dies with a queue in hand leaves none of it") {
  TestPlatform platform;
  const auto process = platform.join();
  Inspection inspection(platform);
  const uint64_t used = inspection.used_bytes();
  SteppedChild child("subscribes_deep", {platform.name(), "1"});
  while (!is_any_in_hand(inspection.registry())) {
    REQUIRE_FALSE(child.finished());
    child.run_to_system_call();
  }
  inspection.registry().header().needs_repair = 1;  // the block stays in the map
  process->add_node("node", "/", "/");
  CHECK(inspection.used_bytes() >= used + deep_bytes);
  child.kill();
  wait_until("it is reaped", [&] { return inspection.used_bytes() == used; });
}

TEST_CASE("a process that dies with a block of seats in hand leaves none of it") {
  Crowd f;
  const uint64_t used = f.inspection.used_bytes();
  SteppedChild child("addresses", {f.platform.name()});
  while (!is_any_in_hand(f.inspection.registry())) {
    REQUIRE_FALSE(child.finished());
    child.run_to_system_call();
  }
  child.kill();
  wait_until("it is reaped", [&] { return f.inspection.used_bytes() == used; });
  CHECK(f.subscriptions.front()->matched().current == 0);
}

TEST_CASE("a full file system: a publish that needs seats is refused, until there is room") {
  if (!has_private_shm()) {
    return;  // never fills the machine's /dev/shm
  }
  wait_until_private_shm_is_free();
  Crowd f;
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(1)));
  struct statvfs fs {};
  REQUIRE(statvfs("/dev/shm", &fs) == 0);
  const uint64_t bytes = (fs.f_blocks - fs.f_bfree) * fs.f_frsize + (16 << 10);
  const std::string size = "size=" + std::to_string(bytes);
  REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, size.c_str()) == 0);
  const Refusal refusal = refusal_of([&] { publish(*publisher, 1); });
  CHECK(refusal.code == ErrorCode::no_space);
  CHECK_MESSAGE(refusal.says("cannot publish on '/x'"), refusal.text);
  CHECK_FALSE(is_any_in_hand(f.inspection.registry()));
  REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, "size=50%") == 0);
  publish(*publisher, 1);
  for (const auto & each : f.subscriptions) {
    CHECK(take_all(*each) == numbers(1, 1));
  }
}

TEST_CASE("a landing is freed with its last subscription; one that comes later gets another one") {
  FromAfar f;
  const uint64_t used = f.inspection.used_bytes(2);
  for (int i = 1; i <= 3; ++i) {
    const std::string number = std::to_string(i);
    const auto subscription = f.subscription();
    f.publisher.tell("publish " + number + " " + number + " 1000");
    CHECK(take_next(*f.process, *subscription).number == static_cast<uint64_t>(i));
  }
  f.inspection.wait_until_swept();  // by the reaper, where publisher or mover was in its phase
  CHECK(f.inspection.used_bytes(2) == used);
}

TEST_CASE("a landing stays while any subscription of its cluster is left") {
  FromAfar f;
  const uint64_t used = f.inspection.used_bytes(2);
  auto first = f.subscription();
  const uint64_t used_by_first = f.inspection.used_bytes(2) - used;
  REQUIRE(used_by_first > dsm_bytes);
  auto second = f.subscription();
  CHECK(f.inspection.used_bytes(2) - used < dsm_bytes + used_by_first);
  first.reset();
  f.publisher.tell("publish 1 1 1000");
  CHECK(take_next(*f.process, *second).number == 1);
  f.inspection.wait_until_swept();
  CHECK(f.inspection.used_bytes(2) - used == used_by_first);
  second.reset();
  f.inspection.wait_until_swept();
  CHECK(f.inspection.used_bytes(2) == used);
}

TEST_CASE("room for one landing is enough for subscriptions that are created at the same time") {
  FromAfar f(profile_of(dsm_bytes + dsm_bytes / 2));
  Registry & registry = f.inspection.registry();
  SteppedChild child("subscribes", {f.platform.name(), "2"});
  while (!is_any_in_hand(registry)) {
    REQUIRE_FALSE(child.finished());
    child.run_to_system_call();
  }
  const uint32_t before = f.inspection.live_endpoints();
  auto other = std::async(std::launch::async, [&] { return f.subscription(); });
  wait_until("the other subscription needs a landing", [&] {
    return f.inspection.live_endpoints() > before;
  });
  while (!child.finished()) {
    child.run_to_system_call();
  }
  const auto subscription = other.get();
  CHECK(subscription->matched().current == 1);
}
