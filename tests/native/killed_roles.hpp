// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "messages.hpp"
#include "node_role.hpp"
#include "stepped_child.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/matching/sweeping.hpp"

/// What the processes do that test_killed.cpp kills.
namespace killed_roles {

using namespace manycore;

constexpr const char * topic = "/x";
constexpr const char * crowded_topic = "/crowded";
constexpr size_t crowd = 100;
constexpr size_t large_bytes = 5'000;  // requires the topic DSM to grow
constexpr const char * sized_topic = "/sized";
constexpr const char * moved_topic = "/moved";
constexpr uint32_t sized_bytes = 300'000;
constexpr uint32_t sized_depth = 10'000;  // a queue of 128 KiB, likewise

inline const Role joins("joins", [](Lines &, const Arguments & arguments) {
  begin_steps();
  join_platform(arguments.at(0));
  finish_steps();
});

inline const Role leaves("leaves", [](Lines &, const Arguments & arguments) {
  auto process = join_platform(arguments.at(0));
  begin_steps();
  process.reset();
  finish_steps();
});

inline const Role creates("creates", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  begin_steps();
  process->remove_node(process->add_node("node", "/", "/"));
  process->create_publisher(on_topic(topic, transient_local(10)));
  process->create_subscription(on_topic(topic, transient_local(10)));
  finish_steps();
});

/// Endpoints that are matched with others and each other.
inline const Role matches("matches", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  begin_steps();
  auto publisher = process->create_publisher(on_topic(topic, transient_local(10)));
  auto subscription = process->create_subscription(on_topic(topic, transient_local(10)));
  publisher.reset();
  subscription.reset();
  finish_steps();
});

/// A subscription and a publisher of a transferred topic, each of which makes a landing.
inline const Role moves("moves", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0), 2);
  begin_steps();
  process->create_subscription(on_topic(moved_topic, keep_last(1)));
  process->create_publisher(on_topic(moved_topic, keep_last(1)));
  finish_steps();
});

/// A topic DSM and a queue that are backed, and given back, without the registry lock.
inline const Role sizes("sizes", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  begin_steps();
  process->create_publisher(on_topic(sized_topic, keep_last(1)));
  process->create_subscription(on_topic(sized_topic, keep_last(sized_depth)));
  finish_steps();
});

inline const Role publishes("publishes", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic(topic, transient_local(2)));
  begin_steps();
  publish(*publisher, 1, sizeof(Payload), 2);
  publish(*publisher, 2, large_bytes, 2);
  publish(*publisher, 3, sizeof(Payload), 2);
  finish_steps();
});

inline const Role takes("takes", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto subscription = process->create_subscription(on_topic(topic, transient_local(2)));
  begin_steps();
  take_all(*subscription);
  finish_steps();
});

inline const Role closes("closes", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  auto subscription = process->create_subscription(on_topic(topic, transient_local(2)));
  begin_steps();
  subscription.reset();
  finish_steps();
});

/// Endpoints with many matches.
inline const Role closes_many("closes_many", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  auto publisher = process->create_publisher(on_topic(crowded_topic, transient_local(2)));
  auto subscription = process->create_subscription(on_topic(crowded_topic, transient_local(2)));
  begin_steps();
  publisher.reset();
  subscription.reset();
  finish_steps();
});

/// Acts like a receive thread that reaps other processes.
inline const Role reaps("reaps", [](Lines &, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  begin_steps();
  reap_dead(registry, 1);
  sweeping::sweep_all(registry);
  finish_steps();
});

/// Messages of two publishers: when the newer one leaves, 100 subscriptions drop the older one's.
inline const Role sweeps_many("sweeps_many", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const EndpointSpec spec = on_topic(crowded_topic, transient_local(1));
  auto newer = process->create_publisher(spec);
  auto older = process->create_publisher(spec);
  publish(*older, 1, sizeof(Payload), 2);
  older.reset();
  publish(*newer, 2, sizeof(Payload), 2);
  begin_steps();
  newer.reset();
  finish_steps();
});

}  // namespace killed_roles
