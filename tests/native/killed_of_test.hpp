// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <doctest/doctest.h>

#include <cstdlib>

#include "killed_roles.hpp"
#include "messages.hpp"
#include "node_role.hpp"
#include "platform_of_test.hpp"
#include "stepped_child.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/transfer/landing.hpp"
#include "waiting.hpp"

/// Kills a process at any instruction of what it does. The test single-steps the process, kills it
/// after a number of instructions, and checks that everything it owned is reclaimed and other
/// processes are unharmed. Only a sample of instruction counts is tested, spread over all:
/// MANYCORE_TEST_STEPS sets its size.
namespace killed_of_test {

using namespace manycore;
using killed_roles::crowd;
using killed_roles::crowded_topic;
using killed_roles::moved_topic;
using killed_roles::sized_bytes;
using killed_roles::sized_topic;
using killed_roles::topic;

/// Small, so that no part of a change takes many instructions.
inline Profile small_profile() {
  Profile profile = host_profile();
  profile.smem_bytes = 8 << 20;
  return profile;
}

/// A publisher and two subscriptions that must keep working.
struct Fixture {
  void crowd_topic(bool with_publishers) {
    const EndpointSpec spec = on_topic(crowded_topic, transient_local(1));
    for (size_t i = 0; i < crowd; ++i) {
      if (with_publishers) {
        publishers.push_back(process->create_publisher(spec));
      }
      subscriptions.push_back(process->create_subscription(spec));
    }
  }

  /// A publisher and a subscription of the topic that is transferred, and a process in cluster 2,
  /// so that the cluster stays.
  void move_topic() {
    resident.emplace(platform, 2);
    publishers.push_back(process->create_publisher(on_topic(moved_topic, keep_last(1))));
    subscriptions.push_back(process->create_subscription(on_topic(moved_topic, keep_last(1))));
  }

  void subscribe_resident() {
    resident->tell(std::string("subscription ") + moved_topic + " 1");
    ++resident_endpoints;
  }

  uint64_t used_bytes() {
    return inspection.used_bytes(1) + (resident ? inspection.used_bytes(2) : 0);
  }

  /// Dead nodes with both kinds of endpoints, not reaped by the receive thread.
  void leave_dead_nodes() {
    Node node(platform, 1);
    node.tell(std::string("publisher ") + topic + " 10");
    node.tell(std::string("subscription ") + topic + " 10");
    node.tell("publish 1 3 1000");
  }

  void wait_until_alone() {
    wait_until("the dead are gone from the registry", [&] {
      take_all(*subscription);  // topic DSMs of dead publishers wait for these takes
      take_all(*other);
      for (const auto & each : subscriptions) {
        take_all(*each);
      }
      return inspection.live_processes() == (resident ? 2 : 1) &&
             inspection.closing_endpoints() == 0 && process->graph().nodes().empty();
    });
    inspection.wait_until_swept();
  }

  /// Messages of this fixture arrive, each once; those of other publishers are ignored.
  void check_that_it_goes_on() {
    ++number;
    if (resident) {
      resident->tell("begin_context");  // it ends if it hears nothing for long
    }
    publish(*publisher, number);
    for (Subscription * const each : {subscription.get(), other.get()}) {
      std::optional<Payload> found;
      while (const std::optional<Payload> taken = take(*each)) {
        found = taken->writer == 1 ? taken : found;
      }
      REQUIRE(found);
      CHECK(found->number == number);
    }
    CHECK(
      inspection.live_endpoints() ==
      3 + publishers.size() + subscriptions.size() + resident_endpoints);
    CHECK(inspection.readers_of(*publisher).size() == 2);
    CHECK(publisher->matched().current == 2);
    CHECK(subscription->matched().current == 1);
  }

  /// A sum that changes with each change of a row of these endpoints' topics.
  uint64_t matches() {
    Registry & registry = inspection.registry();
    return registry.changes_of(hash_name(topic)) + registry.changes_of(hash_name(moved_topic)) +
           registry.changes_of(hash_name(crowded_topic)) + (has_landing() ? 1 : 0);
  }
  bool has_landing() {
    const LandingTable * const table = landings();
    return table != nullptr && table->landings[1].load() != 0;
  }
  const LandingTable * landings() {
    Clusters & clusters = inspection.registry().clusters();
    return resident ? landing_table(clusters.at(1), inspection.header_of(*publishers.front()))
                    : nullptr;
  }

  void check_crowd() {
    for (const auto & each : publishers) {
      CHECK(each->matched().current == subscriptions.size());
    }
    for (const auto & each : subscriptions) {
      CHECK(each->matched().current == publishers.size());
    }
  }

  TestPlatform platform;
  Configurator configurator{
    platform.name(),
    small_profile(),
    {{sized_topic, 1, sized_bytes, 0},
     {moved_topic, 2, sized_bytes, 0, TransferSettings{Transfer::async}}}};
  std::shared_ptr<Process> process = platform.join(1);
  std::unique_ptr<Publisher> publisher =
    process->create_publisher(on_topic(topic, transient_local(2)));
  std::unique_ptr<Subscription> subscription =
    process->create_subscription(on_topic(topic, transient_local(10)));
  std::unique_ptr<Subscription> other =
    process->create_subscription(on_topic(topic, transient_local(10)));
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  std::optional<Node> resident;
  Inspection inspection{platform};
  size_t resident_endpoints = 0;
  uint64_t number = 0;
};

inline std::optional<uint64_t> asked_tries() {
  const char * const asked = std::getenv("MANYCORE_TEST_STEPS");
  return asked == nullptr ? std::nullopt : std::optional(std::stoull(asked));
}

inline uint64_t tries() { return asked_tries().value_or(4); }

/// Kills a process in `role` after this many instructions; returns how many it executed.
inline uint64_t kill_after(Fixture & f, const std::string & role, uint64_t instructions) {
  const bool reaps = role == "reaps";
  std::optional<Standstill> no_other_reaper;
  if (reaps || role == "sweeps_many") {
    no_other_reaper.emplace(f.platform, 1);
  }
  if (reaps) {
    f.leave_dead_nodes();
  }
  SteppedChild child(role, {f.platform.name()});
  const uint64_t done = child.step(instructions);
  child.kill();
  if (reaps) {  // the next owner of the lock repairs what was left incomplete
    f.process->create_publisher(on_topic("/y", keep_last(1)));
    // The reapers look again, as after the end of a receive thread.
    f.inspection.registry().clusters().at(1).wake_reaper();
  }
  return done;
}

inline void check_kills(const std::string & role) {
  Fixture f;
  f.platform.receive_thread(1);
  if (role == "closes_many" || role == "sweeps_many") {
    f.crowd_topic(role == "closes_many");
  }
  if (role == "moves") {
    f.move_topic();
  }
  f.check_that_it_goes_on();
  const uint64_t all = kill_after(f, role, UINT64_MAX);
  CHECK(all > 1000);
  f.wait_until_alone();
  while (f.number < 2000) {
    f.check_that_it_goes_on();
  }
  const uint64_t used = f.used_bytes();
  for (uint64_t i = 1; i <= tries(); ++i) {
    const uint64_t instructions = all * i / (tries() + 1);
    CAPTURE(instructions);
    CAPTURE(all);
    kill_after(f, role, instructions);
    f.wait_until_alone();
    f.check_that_it_goes_on();
    f.check_crowd();
    CHECK(f.used_bytes() == used);
  }
}

}  // namespace killed_of_test
