// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A process that cannot open files cannot map a cluster that it has not used before. The cluster's
// objects are in use all the same: nothing of it is freed, and nothing is forgotten. Repair of the
// registry: test_registry.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "node_role.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

/// Stops both receive threads, whose reapers would help, during its lifetime.
struct NoReapers {
  explicit NoReapers(const TestPlatform & platform) : here(platform, 2), there(platform, 1) {}
  Standstill here;
  Standstill there;
};

/// A node in cluster 1 with an endpoint and without descriptors; then this process joins cluster 2.
struct Fixture {
  explicit Fixture(const std::string & endpoint) {
    platform.receive_thread(1);
    inspection = std::make_unique<Inspection>(platform);
    used_before = inspection->used_bytes(1);
    node.tell(endpoint);
    node.tell("use_up_descriptors");
    process = platform.join(2);
  }

  /// The node destroys its endpoint, but nothing of it is freed.
  void close() {
    const uint64_t used = inspection->used_bytes(1);
    node.tell("close");
    CHECK(inspection->closing_endpoints() == 1);
    CHECK(inspection->used_bytes(1) == used);
    CHECK(process->graph().endpoints_of("/x").size() == 1);
  }
  void wait_until_closed() {
    inspection->wait_until_swept();
    CHECK(inspection->live_endpoints() == 1);
    CHECK(inspection->used_bytes(1) == used_before);
  }

  TestPlatform platform;
  Node node{platform, 1};
  std::unique_ptr<Inspection> inspection;
  uint64_t used_before = 0;
  std::shared_ptr<Process> process;
};

}  // namespace

TEST_CASE("a subscription is closed by a process that reaches its publisher's cluster") {
  Fixture f("subscription /x 10");
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  publish(*publisher, 1);
  {
    const NoReapers none(f.platform);
    f.close();
    CHECK(f.inspection->readers_of(*publisher).empty());
    CHECK(f.inspection->closing_endpoints() == 1);
    publish(*publisher, 2);
  }
  f.wait_until_closed();
  CHECK(f.inspection->readers_of(*publisher).empty());
  CHECK(publisher->matched().current == 0);
  publish(*publisher, 3);
}

TEST_CASE("a publisher is closed by a process that reaches its subscription's cluster") {
  Fixture f("publisher /x 10");
  const auto subscription = f.process->create_subscription(on_topic("/x", keep_last(10)));
  {
    const NoReapers none(f.platform);
    f.close();
  }
  f.wait_until_closed();
  CHECK(subscription->matched().current == 0);
  CHECK_FALSE(take(*subscription));
}

TEST_CASE("an endpoint that no other process closes is closed with its own process") {
  Fixture f("subscription /x 10");
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  {
    const NoReapers none(f.platform);
    f.close();
    CHECK(f.inspection->closing_endpoints() == 1);
    SUBCASE("which leaves with descriptors") {
      f.node.say("leave");  // frees the descriptors before
      CHECK(f.node.wait() == 0);
    }
    SUBCASE("which is killed") { f.node.kill(); }
  }
  f.wait_until_closed();
  CHECK(f.inspection->readers_of(*publisher).empty());
}

TEST_CASE("an endpoint without a match is freed by a process that reaches all clusters") {
  Fixture f("subscription /y 10");
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  {
    const NoReapers none(f.platform);
    f.close();
  }
  f.wait_until_closed();
}

TEST_CASE(
  "messages of a publisher in an unmappable cluster arrive once the cluster can be mapped") {
  Fixture f("subscription /x 10");
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  publish(*publisher, 1);
  CHECK(f.node.ask("look") == "nothing");
  f.node.tell("free_descriptors");
  publish(*publisher, 2);
  f.node.tell("take 1 2 1");
}

TEST_CASE(
  "an endpoint that would match one in a cluster that cannot be mapped is refused, and no slot "
  "lost") {
  Fixture f("subscription /y 10");
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
  const std::string answer = f.node.ask("subscription /x 10");
  CHECK_MESSAGE(answer.find("error: this process cannot map cluster 2") == 0, answer);
  CHECK_MESSAGE(answer.find("ulimit -n") != std::string::npos, answer);
  CHECK(f.node.wait() > 0);
  f.wait_until_closed();
  CHECK(f.inspection->registry().endpoints().high_water() == 2);
  CHECK(publisher->matched().total == 0);
}
