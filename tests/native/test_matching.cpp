// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Which endpoints are matched, what each side is told, and what is left when they are closed.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform_of_test.hpp"
#include "transport/peers/qos_compatibility.hpp"

using namespace manycore;

namespace {

struct Fixture {
  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  std::optional<Standstill> receive_thread{std::in_place, platform, 1};

  std::unique_ptr<Publisher> publisher(const Qos & qos) {
    return process->create_publisher(on_topic("/match", qos));
  }
  std::unique_ptr<Subscription> subscription(const Qos & qos) {
    return process->create_subscription(on_topic("/match", qos));
  }
};

Qos best_effort_transient_local() {
  Qos qos = transient_local(10);
  qos.reliability = Reliability::best_effort;
  return qos;
}

}  // namespace

TEST_CASE("an offer must be at least what is requested; the last incompatible policy is reported") {
  const Qos reliable = keep_last(10);
  CHECK(last_incompatible_policy(reliable, reliable) == QosPolicy::none);
  CHECK(last_incompatible_policy(reliable, best_effort(1)) == QosPolicy::none);
  CHECK(last_incompatible_policy(transient_local(1), keep_all()) == QosPolicy::none);
  CHECK(last_incompatible_policy(best_effort(1), reliable) == QosPolicy::reliability);
  CHECK(last_incompatible_policy(reliable, transient_local(1)) == QosPolicy::durability);
  CHECK(last_incompatible_policy(best_effort(1), transient_local(1)) == QosPolicy::reliability);
  Qos strict = reliable;
  strict.deadline_ns = 1000;
  CHECK(last_incompatible_policy(reliable, strict) == QosPolicy::deadline);
  CHECK(last_incompatible_policy(strict, reliable) == QosPolicy::none);
  strict = reliable;
  strict.liveliness = Liveliness::manual_by_topic;
  CHECK(last_incompatible_policy(reliable, strict) == QosPolicy::liveliness);
  CHECK(last_incompatible_policy(strict, reliable) == QosPolicy::none);
  strict = reliable;
  strict.liveliness_lease_ns = 1000;
  CHECK(last_incompatible_policy(reliable, strict) == QosPolicy::liveliness);
}

TEST_CASE("incompatible ends are counted on both sides, and exchange nothing") {
  Fixture f;
  const auto publisher = f.publisher(best_effort(10));
  const auto reliable = f.subscription(keep_last(10));
  const auto durable = f.subscription(best_effort_transient_local());
  const auto modest = f.subscription(best_effort(10));
  CHECK(publisher->incompatible().total == 2);
  CHECK(publisher->incompatible().last_policy == QosPolicy::durability);
  CHECK(reliable->incompatible().total == 1);
  CHECK(reliable->incompatible().last_policy == QosPolicy::reliability);
  CHECK(modest->incompatible().total == 0);
  CHECK(publisher->matched().current == 1);
  publish(*publisher, 1);
  CHECK_FALSE(reliable->has_data());
  CHECK_FALSE(durable->has_data());
  CHECK(take_all(*modest) == numbers(1, 1));
}

TEST_CASE("endpoints of other type, topic or role do not match; only the type is reported") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(10));
  EndpointSpec type = on_topic("/match", keep_last(10));
  type.type = "test_msgs/msg/Other";
  EndpointSpec role = on_topic("/match", keep_last(10));
  role.role = EndpointRole::request;
  for (const EndpointSpec & spec : {type, role, on_topic("/other", keep_last(10))}) {
    const auto subscription = f.process->create_subscription(spec);
    CHECK(subscription->matched().total == 0);
    CHECK(subscription->incompatible().total == 0);
    CHECK(subscription->incompatible_types() == (spec.type == type.type ? 1 : 0));
    CHECK(publisher->incompatible_types() == 1);
    publish(*publisher, 1);
    CHECK_FALSE(subscription->has_data());
  }
}

TEST_CASE("match counts follow endpoints that are created and closed, in any order") {
  Fixture f;
  auto first = f.publisher(keep_last(10));
  const auto subscription = f.subscription(keep_last(10));
  const auto second = f.publisher(keep_last(10));
  CHECK(subscription->matched().current == 2);
  first.reset();
  CHECK(subscription->matched().current == 1);
  for (uint64_t round = 1; round <= 5; ++round) {
    const auto guest = f.subscription(keep_last(10));
    CHECK(second->matched().current == 2);
    CHECK(second->matched().total == 1 + round);
    publish(*second, round);
    CHECK(take_all(*guest) == numbers(round, round));
  }
  CHECK(second->matched().current == 1);
  CHECK(subscription->matched().total == 2);
  CHECK(take_all(*subscription) == numbers(1, 5));
}

TEST_CASE("ignore_local: not matched with publishers of the same process") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(10));
  EndpointSpec spec = on_topic("/match", keep_last(10));
  spec.ignore_local = true;
  const auto subscription = f.process->create_subscription(spec);
  CHECK(publisher->matched().total == 0);
  CHECK(subscription->matched().total == 0);
  publish(*publisher, 1);
  CHECK_FALSE(subscription->has_data());
}

TEST_CASE("messages of a closed publisher are still taken, then its memory is freed") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.publisher(keep_last(10));
  auto subscription = f.subscription(keep_last(10));
  for (uint64_t number = 1; number <= 5; ++number) {
    publish(*publisher, number, 10'000);
  }
  publisher.reset();
  CHECK(subscription->matched().current == 0);
  CHECK(take_all(*subscription) == numbers(1, 5));
  f.receive_thread.reset();  // its reaper frees what the turn at the last take did not finish
  f.inspection.wait_until_swept();
  CHECK(f.inspection.live_endpoints() == 1);
  subscription.reset();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("memory is freed as well when the subscription is closed without taking") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.publisher(transient_local(10));
  auto subscription = f.subscription(transient_local(10));
  publish(*publisher, 1, 100'000);
  SUBCASE("publisher first") {
    publisher.reset();
    subscription.reset();
  }
  SUBCASE("subscription first") {
    subscription.reset();
    publisher.reset();
  }
  CHECK(f.inspection.live_endpoints() == 0);
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("a subscription has more publishers than one block of sources holds") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto subscription = f.subscription(keep_last(200));
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (uint64_t number = 1; number <= 3 * 15 + 4; ++number) {
    publishers.push_back(f.publisher(keep_last(1)));
    publish(*publishers.back(), number);
  }
  CHECK(take_all(*subscription) == numbers(1, publishers.size()));
  publishers.erase(publishers.begin() + 3, publishers.begin() + 30);
  publishers.push_back(f.publisher(keep_last(1)));  // reuses a free entry
  publish(*publishers.back(), 1000);
  publish(*publishers[10], 1001);
  CHECK(take_all(*subscription) == numbers(1000, 1001));
  publishers.clear();
  subscription.reset();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("a publisher has more subscriptions than its header and one block of readers hold") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.publisher(keep_last(1));
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (uint64_t count = 1; count <= 17 + 2 * 31 + 3; ++count) {
    subscriptions.push_back(f.subscription(keep_last(10)));
  }
  publish(*publisher, 1);
  subscriptions.erase(subscriptions.begin() + 5, subscriptions.begin() + 60);
  subscriptions.push_back(f.subscription(keep_last(10)));
  publish(*publisher, 2);
  CHECK(take_all(*subscriptions.back()) == numbers(2, 2));
  subscriptions.pop_back();
  for (const auto & subscription : subscriptions) {
    CHECK(take_all(*subscription) == numbers(1, 2));
  }
  publisher.reset();
  subscriptions.clear();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE(
  "a publisher that cannot map a subscription's cluster says so, and publishes once it can") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(10));
  const auto near = f.subscription(keep_last(10));
  Node far(f.platform, 2);
  far.tell("subscription /match 10");
  f.platform.receive_thread(2);
  const std::string path = f.platform.paths().pipe(2);
  // Replaces the file atomically: a missing file would mean that the platform was removed.
  std::filesystem::create_hard_link(path, path + ".away");
  std::ofstream(path + ".no_pipe") << "no pipe";
  std::filesystem::permissions(path + ".no_pipe", std::filesystem::perms(0600));
  std::filesystem::rename(path + ".no_pipe", path);
  for (int i = 0; i < 2; ++i) {
    const Refusal refusal = refusal_of([&] { publish(*publisher, 1); });
    CHECK(refusal.code == ErrorCode::corrupt);
    CHECK_MESSAGE(refusal.says("publish on '/match'"), refusal.text);
    CHECK_MESSAGE(refusal.says(path), refusal.text);
  }
  CHECK_FALSE(take(*near));
  std::filesystem::rename(path + ".away", path);
  publish(*publisher, 1);
  far.tell("take 1 1 1");
  CHECK(take_all(*near) == numbers(1, 1));
}

TEST_CASE("endpoints that are created at the same time are matched once each") {
  constexpr uint32_t count = 150;  // more than are matched in one turn
  Fixture f;
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  std::thread other([&] {
    for (uint32_t i = 0; i < count; ++i) {
      publishers.push_back(f.publisher(keep_last(1)));
    }
  });
  for (uint32_t i = 0; i < count; ++i) {
    subscriptions.push_back(f.subscription(keep_last(1)));
  }
  other.join();
  for (uint32_t i = 0; i < count; ++i) {
    CHECK(publishers[i]->matched().current == count);
    CHECK(publishers[i]->matched().total == count);
    CHECK(subscriptions[i]->matched().current == count);
    CHECK(subscriptions[i]->matched().total == count);
    CHECK(f.inspection.readers_of(*publishers[i]).size() == count);
  }
}

TEST_CASE("a match wakes the process only while a thread waits for endpoint events") {
  Fixture f;
  Waiter & waiter = f.process->waiters().common();
  const auto publisher = f.publisher(keep_last(10));
  const uint32_t unwatched = waiter.epoch();
  auto subscription = f.subscription(keep_last(10));
  CHECK(waiter.epoch() == unwatched);
  f.process->waiters().event_watchers().add(common_word);
  subscription.reset();
  CHECK(waiter.epoch() != unwatched);
  const uint32_t before = waiter.epoch();
  subscription = f.subscription(keep_last(10));
  CHECK(waiter.epoch() != before);
  f.process->waiters().event_watchers().remove(common_word);
}

TEST_CASE("invalid values are refused by name, and leave nothing behind") {
  Fixture f;
  Qos deadline = keep_last(10);
  deadline.deadline_ns = 0;
  Qos lease = keep_last(10);
  lease.liveliness_lease_ns = -1;
  const auto refused = [&](const Qos & qos) { return refusal_of([&] { f.publisher(qos); }); };
  CHECK(refused(deadline).code == ErrorCode::invalid_argument);
  CHECK(refused(deadline).says("deadline of 0 ns"));
  CHECK(refused(lease).says("liveliness lease duration of -1 ns"));
  CHECK(refused(keep_last(0)).code == ErrorCode::invalid_argument);
  CHECK(refused(keep_last(0)).says("depth 0"));
  CHECK(f.inspection.live_endpoints() == 0);
}
