// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The chains of endpoints by topic, which a new endpoint walks without the registry lock.
#include <doctest/doctest.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "child.hpp"
#include "messages.hpp"
#include "platform_of_test.hpp"
#include "stepped_child.hpp"

using namespace manycore;

namespace {

/// Dies holding the registry lock, in the middle of a repair.
const Role repairer("repairer", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const Registry::Lock lock(registry);
  for (TopicBucket & bucket : registry.header().topic_buckets) {
    bucket.first = nothing;
  }
  test.say("holding");
  raise(SIGSTOP);
});

/// Repeatedly walks along the endpoints older than its own. Each walk must find the oldest
/// endpoint; reports after each walk.
const Role walker("walker", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/chain", keep_last(1)));
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const auto oldest = static_cast<uint32_t>(std::stoul(arguments.at(1)));
  begin_steps();
  while (true) {
    bool found = false;
    registry.walk_bucket(hash_name("/chain"), [&](uint32_t slot, uint32_t) {
      found = found || slot == oldest;
      return true;
    });
    test.say(found ? "ok" : "missed the oldest");
  }
});

using Slots = std::vector<uint32_t>;

struct Fixture {
  std::unique_ptr<Subscription> subscription(const std::string & topic = "/chain") {
    return process->create_subscription(on_topic(topic, keep_last(1)));
  }
  uint32_t slot_of(const Subscription & subscription) {
    return inspection.slot_of(subscription.gid());
  }
  /// From the second youngest to the oldest.
  template<typename Visit>
  void walk(Visit visit) {
    const uint32_t first = inspection.slot_of(youngest->gid());
    registry.walk_bucket(hash_name("/chain"), [&](uint32_t slot, uint32_t) {
      if (slot != first) {
        visit(slot);
      }
      return true;
    });
  }
  Slots older() {
    Slots slots;
    walk([&](uint32_t slot) { slots.push_back(slot); });
    return slots;
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  Registry & registry = inspection.registry();
  Standstill receive_thread{platform, 1};
  std::unique_ptr<Subscription> first = subscription();
  std::unique_ptr<Subscription> second = subscription();
  std::unique_ptr<Subscription> third = subscription();
  std::unique_ptr<Publisher> youngest = process->create_publisher(on_topic("/chain", keep_last(1)));
};

}  // namespace

TEST_CASE("older endpoints are found by age, not by slot, also after a repair") {
  Fixture f;
  const uint32_t free_slot = f.slot_of(*f.first);
  f.first.reset();
  const auto late = f.subscription();
  REQUIRE(f.slot_of(*late) == free_slot);
  f.youngest.reset();
  f.youngest = f.process->create_publisher(on_topic("/chain", keep_last(1)));
  const Slots expected{free_slot, f.slot_of(*f.third), f.slot_of(*f.second)};
  CHECK(f.older() == expected);
  Child dead("repairer", {f.platform.name()});
  dead.expect("holding");
  dead.kill();
  { const Registry::Lock repairs(f.registry); }
  CHECK(f.older() == expected);
  f.third.reset();
  CHECK(f.older() == Slots{expected[0], expected[2]});
}

// Not a proof for each step of a repair; the walks meet many of them.
TEST_CASE("a walk from the bucket misses no endpoint while repairs run") {
  Fixture f;
  std::atomic<bool> is_repairing{true};
  uint64_t walks = 0;
  uint64_t short_walks = 0;
  std::thread walker([&] {
    while (is_repairing) {
      Slots visited;
      f.registry.walk_bucket(hash_name("/chain"), [&](uint32_t slot, uint32_t) {
        visited.push_back(slot);
        return true;
      });
      short_walks += visited.size() == 4 ? 0 : 1;
      ++walks;
    }
  });
  for (int repair = 0; repair < 2'000; ++repair) {
    f.registry.header().needs_repair = 1;
    const Registry::Lock repairs(f.registry);
  }
  is_repairing = false;
  walker.join();
  CHECK(walks > 0);
  CHECK(short_walks == 0);
}

TEST_CASE("a walk goes back when its current endpoint has moved to another chain") {
  Fixture f;
  const uint32_t slot = f.slot_of(*f.third);
  std::unique_ptr<Subscription> other;
  Slots visited;
  f.walk([&](uint32_t found) {
    visited.push_back(found);
    if (other == nullptr) {
      f.third.reset();
      other = f.subscription("/other");
    }
  });
  REQUIRE(f.slot_of(*other) == slot);
  CHECK(visited == Slots{slot, f.slot_of(*f.second), f.slot_of(*f.first)});
}

TEST_CASE("a walk goes back past all endpoints that have left") {
  Fixture f;
  const Slots all{f.slot_of(*f.third), f.slot_of(*f.second), f.slot_of(*f.first)};
  std::vector<std::unique_ptr<Subscription>> others;
  Slots visited;
  f.walk([&](uint32_t found) {
    visited.push_back(found);
    if (visited.size() == 2) {
      f.second.reset();
      f.third.reset();
      others.push_back(f.subscription("/other"));
      others.push_back(f.subscription("/other"));
    }
  });
  CHECK(visited == all);
}

// The walk is at its own endpoint and has loaded the next one, whose slot moves to another chain
// before the walk gets there. The test case above covers the other way to be led astray.
TEST_CASE("a walk notices that the next endpoint left, after each of its instructions") {
  Fixture f;
  constexpr uint64_t more_than_a_step_takes = 150;
  std::vector<std::unique_ptr<Subscription>> next;
  for (uint64_t i = 0; i < more_than_a_step_takes; ++i) {
    next.push_back(f.subscription());
  }
  SteppedChild walker("walker", {f.platform.name(), std::to_string(f.slot_of(*f.first))});
  std::vector<std::unique_ptr<Subscription>> others;
  for (uint64_t instructions = 0; instructions < more_than_a_step_takes; ++instructions) {
    CAPTURE(instructions);
    walker.step(instructions);
    next.pop_back();
    others.push_back(f.subscription("/other"));
    while (!walker.lines().has_news()) {
      walker.run_to_system_call();
    }
    REQUIRE(walker.hear() == "ok");
  }
}

TEST_CASE("a walk continues past endpoints that leave before it reaches them") {
  Fixture f;
  const Slots expected{f.slot_of(*f.third), f.slot_of(*f.first)};
  Slots visited;
  f.walk([&](uint32_t found) {
    visited.push_back(found);
    f.second.reset();
  });
  CHECK(visited == expected);
}

TEST_CASE("an endpoint whose predecessor is damaged still leaves its chain") {
  Fixture f;
  const Slots expected{f.slot_of(*f.third), f.slot_of(*f.first)};
  uint32_t & previous = f.registry.endpoints()[f.slot_of(*f.second)].previous_of_topic;
  SUBCASE("by another endpoint") { previous = f.slot_of(*f.first); }
  SUBCASE("by none") { previous = nothing; }
  f.second.reset();
  CHECK(f.older() == expected);
}
