// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The graph is read without the registry lock: a reader delays no change, a stopped change delays
// no reader, and entries are read consistently.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/mount.h>

#include <csignal>
#include <thread>

#include "messages.hpp"
#include "node_role.hpp"
#include "private_shm.hpp"
#include "stepped_child.hpp"
#include "transport/registry/snapshot.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

/// Reads the graph in a loop, and answers what it hears.
const Role reader("reader", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  Graph graph(registry);
  test.say("reading");
  while (true) {
    for (int i = 0; i < 10; ++i) {
      graph.endpoints();
    }
    if (test.has_news()) {
      test.say(test.hear());
    }
  }
});

/// Stops while holding the registry lock, with a topic's chain broken.
const Role changer("changer", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const Registry::Lock lock(registry);
  registry.unlink_endpoint(0);
  test.say("changing");
  raise(SIGSTOP);
});

/// Reads the activity of all endpoints in a loop, and reports after each look.
const Role counter("counter", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  Graph graph(registry);
  graph.activity();  // maps the cluster
  begin_steps();
  while (true) {
    graph.activity();
    test.say("read");
  }
});

/// Fills /dev/shm up to its last page during its lifetime.
class FullFileSystem {
public:
  FullFileSystem() : file_(open("/dev/shm", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)) {
    require(static_cast<bool>(file_));
    off_t used = 0;
    for (off_t step = 1 << 20; step >= static_cast<off_t>(page_bytes);) {
      if (posix_fallocate(file_.get(), used, step) == 0) {
        used += step;
      } else {
        step /= 2;
      }
    }
  }

private:
  FileDescriptor file_;
};

/// A subscription at a page boundary, so that a hole replaces its header when it is freed. It has
/// the first slot, which graph reads visit first.
class DeepSubscription {
public:
  explicit DeepSubscription(const TestPlatform & platform)
  : process_(platform.join()), inspection_(platform) {
    auto first_slot = process_->create_publisher(on_topic("/slot", keep_last(1)));
    create();
    while (!is_page_aligned()) {
      destroy();
      in_front_.push_back(process_->create_subscription(on_topic("/in_front", keep_last(1))));
      create();
    }
    destroy();
    first_slot.reset();
    inspection_.wait_until_swept();
    create();
    require(is_page_aligned() && inspection_.slot_of(subscription_->gid()) == 0);
  }
  void create() {
    subscription_ = process_->create_subscription(on_topic("/x", keep_last(65'535)));
  }
  void destroy() {
    subscription_.reset();
    inspection_.wait_until_swept();
  }

private:
  bool is_page_aligned() {
    return reinterpret_cast<uintptr_t>(&inspection_.header_of(*subscription_)) % page_bytes == 0;
  }

  std::shared_ptr<Process> process_;
  Inspection inspection_;
  std::vector<std::unique_ptr<Subscription>> in_front_;
  std::unique_ptr<Subscription> subscription_;
};

/// A name of one repeated letter, nearly of maximum length.
std::string long_name(char letter) { return "/" + std::string(200, letter); }

bool is_whole(const std::string & text) {
  return text == long_name(text.at(1)) && text.size() == 201;
}

EndpointSpec endpoint_of(char letter) {
  EndpointSpec spec = on_topic(long_name(letter), keep_last(1));
  spec.type = long_name(letter);
  return spec;
}

}  // namespace

TEST_CASE("a reader stopped in the middle of a read delays no create") {
  TestPlatform platform;
  const auto process = platform.join();
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (int i = 0; i < 200; ++i) {  // makes a read take some time
    publishers.push_back(process->create_publisher(on_topic("/x", keep_last(1))));
  }
  Child child("reader", {platform.name()});
  child.expect("reading");
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    child.say("on its way");
    child.expect("on its way");
    const int64_t moment = monotonic_ns() + round * 7'000;  // different in each round
    while (monotonic_ns() < moment) {
    }
    child.stop();
    const Refusal refusal =
      refusal_of([&] { process->create_publisher(on_topic("/y", keep_last(1))); });
    CHECK_MESSAGE(!refusal.code, refusal.text);
    child.resume();
  }
}

TEST_CASE("a stopped change delays no reader: entries are found without the chains") {
  TestPlatform platform;
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
  process->add_node("node", "/", "/");
  Child child("changer", {platform.name()});
  child.expect("changing");
  child.wait_until_stopped();
  CHECK(process->graph().endpoints_of("/x").size() == 1);
  CHECK(process->graph().endpoints_of("/y").empty());
  CHECK(process->graph().endpoints().size() == 1);
  CHECK(process->graph().nodes().size() == 1);
  CHECK(process->graph().processes().size() == 1);
  child.kill();
}

TEST_CASE("entries read while others are added and removed are consistent, and none is missing") {
  // Cannot prove that all interleavings are harmless; it meets many of them.
  TestPlatform platform;
  const auto process = platform.join();
  std::atomic<bool> running{true};
  const auto steady = process->create_publisher(endpoint_of('s'));
  std::thread churn([&] {
    for (char letter = 'a'; running; letter = letter == 'z' ? 'a' : static_cast<char>(letter + 1)) {
      const auto publisher = process->create_publisher(endpoint_of(letter));
      const uint32_t node =
        process->add_node(long_name(letter), long_name(letter), long_name(letter));
      process->remove_node(node);
    }
  });
  size_t torn = 0;
  size_t missing = 0;
  for (int round = 0; round < 2'000; ++round) {
    const std::vector<EndpointInfo> endpoints = process->graph().endpoints();
    for (const EndpointInfo & info : endpoints) {
      torn += is_whole(info.topic) && info.topic == info.type ? 0 : 1;
    }
    for (const NodeInfo & info : process->graph().nodes()) {
      torn += is_whole(info.name) && info.ns == info.name && info.enclave == info.name ? 0 : 1;
    }
    missing += endpoints.empty() ? 1 : 0;
    missing += process->graph().endpoints_of(long_name('s')).empty() ? 1 : 0;
  }
  running = false;
  churn.join();
  CHECK(torn == 0);
  CHECK(missing == 0);
}

TEST_CASE("a copy of an entry holds until the slot is closed, or used again") {
  TestPlatform platform;
  const auto process = platform.join();
  auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
  Registry registry(platform.paths());
  const EntryCopy<EndpointEntry> of_publisher(registry.endpoints(), 0);
  CHECK(text_of((*of_publisher).topic) == "/x");
  CHECK(of_publisher.holds());
  publisher.reset();
  CHECK_FALSE(of_publisher.holds());
  const EntryCopy<EndpointEntry> of_nothing(registry.endpoints(), 0);
  CHECK_FALSE(of_nothing.holds());
  publisher = process->create_publisher(on_topic("/y", keep_last(1)));
  REQUIRE(registry.endpoints().is_live(0));
  CHECK_FALSE(of_publisher.holds());
  CHECK_FALSE(of_nothing.holds());
}

TEST_CASE("a read concurrent with a change is repeated, but a bounded number of times") {
  TestPlatform platform;
  const auto process = platform.join();
  platform.receive_thread(1);
  const Standstill receive_thread(platform, 1);  // it changes nothing meanwhile
  Registry registry(platform.paths());
  int reads = 0;
  const auto read = [&](int changes) {
    return read_between_changes(registry, [&](bool is_changing) {
      CHECK_FALSE(is_changing);
      if (++reads <= changes) {
        const Registry::Lock change(registry);
      }
      return reads;
    });
  };
  CHECK(read(0) == 1);
  reads = 0;
  CHECK(read(1) == 2);
  reads = 0;
  CHECK(read(1000) == 16);
  const Registry::Lock change(registry);
  CHECK(read_between_changes(registry, [](bool is_changing) { return is_changing; }));
}

TEST_CASE("a read follows no reference to memory that is freed after one of its instructions") {
  if (!has_private_shm()) {
    return;  // never fills the machine's /dev/shm
  }
  wait_until_private_shm_is_free();
  REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, "size=8m") == 0);
  {
    TestPlatform platform;
    DeepSubscription subscription(platform);
    SteppedChild child("counter", {platform.name()});
    constexpr uint64_t more_than_the_entry_takes = 1'600;
    for (uint64_t instructions = 0; instructions < more_than_the_entry_takes; instructions += 20) {
      CAPTURE(instructions);
      child.step(instructions);
      subscription.destroy();
      {
        const FullFileSystem full;
        while (!child.lines().has_news()) {
          child.run_to_system_call();
        }
        REQUIRE(child.hear() == "read");
      }
      subscription.create();
    }
  }
  REQUIRE(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, "size=50%") == 0);
}

TEST_CASE("activity reports the counters of endpoints and the length of their queues") {
  TestPlatform platform;
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(10)));
  const auto subscription = process->create_subscription(on_topic("/x", keep_last(10)));
  publish(*publisher, 1);
  REQUIRE(take(*subscription));  // scans the new source, so it does not use hints
  publish(*publisher, 2);
  publish(*publisher, 3);
  const std::vector<Activity> rows = process->graph().activity();
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].endpoint == endpoint_in(publisher->gid()));
  CHECK(rows[0].counters.messages == 3);
  CHECK(rows[0].capacity == 0);
  CHECK(rows[1].endpoint == endpoint_in(subscription->gid()));
  CHECK(rows[1].counters.messages == 1);
  CHECK(rows[1].queued == 2);
  CHECK(rows[1].capacity == 10);
  EndpointInfo info;
  info.id = endpoint_in(subscription->gid());
  CHECK(process->graph().activity_of({info}, HeldMemory::skipped).at(0).queued == 2);
  CHECK(process->graph().activity_of({EndpointInfo{}}, HeldMemory::skipped).empty());
}
