// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A subscriber stopped by SIGSTOP while it reads a record delays no other process. tests/stress
// measures that the publisher's rate is unchanged; here: that it publishes at all, and what each
// side has afterwards.
#include <doctest/doctest.h>

#include <unistd.h>

#include <csignal>
#include <fstream>
#include <optional>
#include <string>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform/clock.hpp"
#include "platform/file_lock.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

/// Stops while holding the registry lock, as a process may that is stopped while it joins or
/// leaves.
const Role lock_holder("lock_holder", [](Lines & test, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const Registry::Lock lock(registry);
  test.say("locked");
  raise(SIGSTOP);
});

/// Publishes the first message of a topic DSM, which has to grow for it.
const Role large_publisher("large_publisher", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/growing", keep_last(1)));
  test.say("ready");
  test.hear();
  const Refusal refusal = refusal_of([&] { publish(*publisher, 1, 60'000); });
  test.say(refusal.code ? refusal.text : "published");
});

/// Holds a lock file, as a process does that joins a platform, stopped or running.
const Role file_lock_holder("file_lock_holder", [](Lines & test, const Arguments & arguments) {
  const auto lock = FileLock::acquire(arguments.at(0), 0);
  test.say("locked");
  test.hear();
});

/// Waits for such a lock.
constexpr int lock_timeout_ms = 2000;
const Role file_lock_waiter("file_lock_waiter", [](Lines & test, const Arguments & arguments) {
  test.say("waiting");
  const Refusal refusal = refusal_of([&] { FileLock::acquire(arguments.at(0), lock_timeout_ms); });
  test.say(refusal.code ? refusal.text : "locked");
});

/// A lock file in a private directory, removed at its end.
struct LockFile {
  LockFile() {
    directory = mkdtemp(directory.data());
    path = directory + "/lock";
  }
  ~LockFile() {
    unlink(path.c_str());
    rmdir(directory.c_str());
  }
  std::string directory = "/dev/shm/manycore-lock-of-test-XXXXXX";
  std::string path;
};

/// Leaves a platform when it is told to.
const Role leaver("leaver", [](Lines & test, const Arguments & arguments) {
  auto process = join_platform(arguments.at(0));
  test.say("ready");
  test.hear();
  process.reset();
  test.say("left");
});

/// How often the process has slept.
uint64_t sleeps_of(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;) {
    if (word == "voluntary_ctxt_switches:") {
      uint64_t count = 0;
      status >> count;
      return count;
    }
  }
  return 0;
}

struct Fixture {
  /// Waits until the receive thread of the only subscription in `cluster` has pushed this many
  /// hints.
  void wait_for_hints(uint32_t cluster, uint64_t count) {
    const ClusterHeader & header = inspection.registry().clusters().at(cluster).header();
    wait_until("the hints", [&] { return header.notifications.load() >= count; });
  }

  TestPlatform platform;
  Configurator configurator{platform.name(), host_profile(), {{"/fixed", 1, 4000, 0}}};
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
};

void publish_numbers(Publisher & publisher, uint64_t first, uint64_t last) {
  for (uint64_t number = first; number <= last; ++number) {
    publish(publisher, number, 100 + number % 7 * 50);
  }
}

}  // namespace

TEST_CASE(
  "stopped with a claim: the publisher continues, others get everything, the claim stays intact") {
  for (const std::string topic : {"/fixed", "/growing"}) {
    for (const uint32_t cluster : {1u, 2u}) {
      CAPTURE(topic);
      CAPTURE(cluster);
      Fixture f;
      const auto publisher = f.process->create_publisher(on_topic(topic, keep_last(10)));
      const auto near = f.process->create_subscription(on_topic(topic, keep_last(10)));
      Node stopped(f.platform, cluster);
      stopped.tell("subscription " + topic + " 3");
      publish(*publisher, 1, 500, 7);
      CHECK(stopped.ask("claim") == "1");
      stopped.stop();
      CHECK(take_all(*near) == numbers(1, 1));
      for (uint64_t number = 2; number <= 2000; ++number) {
        publish(*publisher, number, 100 + number % 7 * 50);
        REQUIRE(take(*near)->number == number);
      }
      if (cluster != 1) {
        f.wait_for_hints(cluster, 2000);
      }
      stopped.resume();
      stopped.tell("release");
      stopped.tell("take 1998 2000 1");
    }
  }
}

TEST_CASE("stopped between messages: it finds the newest when it continues") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/fixed", keep_last(10)));
  Node stopped(f.platform, 2);
  stopped.tell("subscription /fixed 4");
  publish_numbers(*publisher, 1, 1);
  stopped.tell("take 1 1 1");
  stopped.stop();
  publish_numbers(*publisher, 2, 2000);
  f.wait_for_hints(2, 2000);
  stopped.resume();
  stopped.tell("take 1997 2000 1");
}

TEST_CASE(
  "stopped in a RELIABLE + KEEP_ALL match: the publisher waits its bound, then reports it") {
  Fixture f;
  Qos qos = keep_all();
  const auto publisher = f.process->create_publisher(on_topic("/fixed", qos));
  Node stopped(f.platform, 1);
  stopped.tell("subscription /fixed keep_all");
  publish(*publisher, 1, 500);
  CHECK(stopped.ask("claim") == "1");
  stopped.stop();
  uint64_t last = 1;
  const Refusal refusal = refusal_of([&] {
    while (last < 1000) {
      publish(*publisher, last + 1, 500);
      ++last;
    }
  });
  CHECK((refusal.code == ErrorCode::timeout || refusal.code == ErrorCode::no_space));
  stopped.resume();
  stopped.tell("release");
  stopped.tell("take 2 " + std::to_string(last) + " 1");
  publish(*publisher, last + 1, 500);
  stopped.tell("take " + std::to_string(last + 1) + " " + std::to_string(last + 1) + " 1");
}

TEST_CASE("a stopped publisher delays no subscriber, and no other publisher") {
  // A fixed topic DSM does not grow. A publisher stopped during the microseconds in which growing
  // holds the registry lock would delay processes that create or close endpoints.
  Fixture f;
  const auto near = f.process->create_subscription(on_topic("/fixed", keep_last(10)));
  Node stopped(f.platform, 1);
  stopped.tell("publisher /fixed 10");
  stopped.say("publish_endlessly 200");
  take_next(*f.process, *near);
  stopped.stop();  // at any moment of a publish
  const auto publisher = f.process->create_publisher(on_topic("/fixed", keep_last(10)));
  publish_numbers(*publisher, 1, 100);
  uint64_t last = 0;
  while (last < 100) {
    const Payload payload = take_next(*f.process, *near);
    last = payload.writer == 1 ? payload.number : last;
  }
  const auto late = f.process->create_subscription(on_topic("/fixed", keep_last(10)));
  publish_numbers(*publisher, 101, 101);
  CHECK(take_next(*f.process, *late).number == 101);
  stopped.kill();
}

TEST_CASE(
  "stopped while it holds the registry lock: publishers whose topic DSM would grow continue") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/growing", keep_last(1000)));
  const auto near = f.process->create_subscription(on_topic("/growing", keep_last(1000)));
  Node node(f.platform, 1);
  node.tell("publisher /growing 1000");
  const Standstill receive_thread(
    f.platform, 1);  // its reaper would wait for the lock as well, and get it first
  Child holder("lock_holder", {f.platform.name()});
  holder.expect("locked");
  // Each publish finds a wanted record in its way. Waiting for the lock each time would take longer
  // than Node::tell() waits.
  node.tell("publish 1 2000 100");
  const Refusal refusal = refusal_of([&] { publish(*publisher, 1, 60'000); });
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK_MESSAGE(refusal.says("registry stayed locked"), refusal.text);
  CHECK(f.inspection.generations_of(*publisher) == 1);
  holder.kill();
  publish(*publisher, 2, 60'000);
  CHECK(f.inspection.generations_of(*publisher) == 2);
  node.tell("publish 2001 2100 100");
  take_all(*near);
}

TEST_CASE("a first message waits for the registry lock as long as its owner is not stopped") {
  Fixture f;
  const auto near = f.process->create_subscription(on_topic("/growing", keep_last(1)));
  Child publisher("large_publisher", {f.platform.name()});
  publisher.expect("ready");
  {
    const Standstill no_other(f.platform, 1);
    const Registry::Lock lock(f.inspection.registry());
    publisher.say("go");
    wait_until("it waits for the lock", [&] {
      return f.inspection.registry().header().mutex.is_waited_for();
    });
    const int64_t until_ns = monotonic_ns() + 3 * Registry::Lock::short_wait_ns;
    wait_until("a stopped owner would be waited for no more", [&] {
      return monotonic_ns() > until_ns || publisher.lines().has_news();
    });
  }
  publisher.expect("published");
  CHECK(take_all(*near) == numbers(1, 1));
}

TEST_CASE("a process that leaves where the registry lock stays taken keeps no other from joining") {
  Fixture f;
  Child leaving("leaver", {f.platform.name()});
  leaving.expect("ready");
  const Standstill receive_thread(f.platform, 1);  // its reaper would wait for the lock as well
  Child holder("lock_holder", {f.platform.name()});
  holder.expect("locked");
  leaving.say("go");
  wait_until("it waits for the lock", [&] {
    return f.inspection.registry().header().mutex.is_waited_for();
  });
  const TestPlatform other;
  const auto joined = other.join();
  CHECK_FALSE(leaving.lines().has_news());  // it is leaving still
  holder.kill();
  leaving.expect("left");
}

TEST_CASE("time in which a process is stopped does not count as waiting for a lock file") {
  const LockFile file;
  const std::string & path = file.path;
  std::optional<FileLock> lock = FileLock::acquire(path, 0);
  Child waiter("file_lock_waiter", {path});
  waiter.expect("waiting");
  waiter.stop();
  const int64_t until_ns = monotonic_ns() + int64_t{lock_timeout_ms} * 1'100'000;
  wait_until("it would wait no longer", [&] { return monotonic_ns() > until_ns; });
  const uint64_t before = sleeps_of(waiter.pid());
  waiter.resume();
  wait_until("it has looked again and again", [&] {
    return sleeps_of(waiter.pid()) > before + 3 || waiter.lines().has_news();
  });
  lock.reset();
  waiter.expect("locked");
}

TEST_CASE("the owner of a lock file is named, and called stopped only if it is") {
  const LockFile file;
  const std::string & path = file.path;
  Child holder("file_lock_holder", {path});
  holder.expect("locked");
  const std::string owner = "process " + std::to_string(holder.pid()) + " (";
  const auto refused = [&] { return refusal_of([&] { FileLock::acquire(path, 1); }); };
  Refusal refusal = refused();
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK_MESSAGE(refusal.says("has been locked for 1 ms: " + owner), refusal.text);
  CHECK_MESSAGE(refusal.says("is not stopped"), refusal.text);
  holder.stop();
  refusal = refused();
  CHECK_MESSAGE(refusal.says(owner), refusal.text);
  CHECK_MESSAGE(refusal.says("is stopped; continue it"), refusal.text);
  holder.kill();
  CHECK(FileLock::acquire(path, 1));
}
