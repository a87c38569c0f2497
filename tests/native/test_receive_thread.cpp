// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Messages between clusters, and what happens to them when a receive thread is killed, stopped or
// fed garbage. The kills here are those that a test can trigger from outside; for all others see
// tests/stress.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>
#include <vector>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform/error.hpp"
#include "platform/file_descriptor.hpp"
#include "platform/os_process.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/peers/peers.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint32_t deep = 30'000;  ///< depth of a queue that no test fills
constexpr uint32_t room_for_all_bytes = 2 << 20;

/// A publisher in cluster 1, and a subscriber in cluster 2. The topic DSM has room for everything
/// that a test publishes: one that had to grow would overwrite messages if a starting or reaping
/// receive thread holds the registry lock too long.
struct Fixture {
  explicit Fixture(const std::string & subscriber_qos = std::to_string(deep)) {
    subscriber.tell("subscription /x " + subscriber_qos);
    wait_until("a match", [&] { return publisher->matched().current == 1; });
  }
  ~Fixture() {
    publisher.reset();
    process.reset();
  }

  void publish_numbers(uint64_t first, uint64_t last) {
    for (uint64_t number = first; number <= last; ++number) {
      publish(*publisher, number);
    }
  }
  void expect(uint64_t first, uint64_t last) {
    subscriber.tell("take " + std::to_string(first) + " " + std::to_string(last) + " 1");
  }
  ClusterHeader & far_cluster() { return inspection.registry().clusters().at(2).header(); }

  TestPlatform platform;
  Configurator configurator{platform.name(), host_profile(), {{"/x", 1, room_for_all_bytes, 0}}};
  std::shared_ptr<Process> process = platform.join(1);
  std::unique_ptr<Publisher> publisher = process->create_publisher(on_topic("/x", keep_last(deep)));
  Node subscriber{platform, 2};
  Inspection inspection{platform};
};

const Role niced("niced", [](Lines & test, const Arguments & arguments) {
  const sched_param none{};
  require(sched_setscheduler(0, SCHED_BATCH, &none) == 0);
  if (geteuid() == 0) {  // unprivileged processes could not revert it
    require(setpriority(PRIO_PROCESS, 0, 5) == 0);
  }
  require(chdir("/dev/shm") == 0);
  rlimit files{};
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = 64;
  require(setrlimit(RLIMIT_NOFILE, &files) == 0);
  join_and_stay(test, arguments.at(0));
});

/// Opens a pipe as a foreign process would.
FileDescriptor open_pipe(const std::string & path) {
  return FileDescriptor(open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
}

/// Number of unread messages.
size_t messages_in(const std::string & path) {
  const FileDescriptor pipe = open_pipe(path);
  int bytes = 0;
  REQUIRE(ioctl(pipe.get(), FIONREAD, &bytes) == 0);
  return static_cast<size_t>(bytes) / sizeof(EmcosMessage);
}

}  // namespace

TEST_CASE("one eMCOS message per record and cluster, one hint per subscription there") {
  Fixture f;
  Node other(f.platform, 2);
  other.tell("subscription /x 30000");
  f.platform.receive_thread(1);  // wait for it: it sends a message when it starts
  const uint64_t notifications = f.far_cluster().notifications;
  {
    const Standstill receive_thread(f.platform, 2);
    const std::string pipe = f.platform.paths().pipe(2);
    const size_t before = messages_in(pipe);
    f.publish_numbers(1, 100);
    CHECK(messages_in(pipe) == before + 100);
  }
  f.expect(1, 100);
  other.tell("take 1 100 1");
  // A subscriber that scans its sources on the first hint may be faster than the receive thread.
  // Once it has the hint of a later message, all earlier hints were pushed.
  f.publish_numbers(101, 101);
  f.expect(101, 101);
  other.tell("take 101 101 1");
  wait_until("all hints", [&] { return f.far_cluster().notifications - notifications >= 202; });
  CHECK(f.far_cluster().notifications - notifications == 202);
}

TEST_CASE("a message for one subscription is pushed to that one, if it is still there") {
  Fixture f;
  Node other(f.platform, 2);
  other.tell("subscription /x 30000");
  wait_until("a match", [&] { return f.publisher->matched().current == 2; });
  f.platform.receive_thread(2);
  f.publish_numbers(1, 1);
  wait_until("both hints", [&] { return f.far_cluster().notifications == 2; });
  const uint32_t slot = f.inspection.slot_of(f.publisher->gid());
  Registry & registry = f.inspection.registry();
  const EndpointEntry & publisher = registry.endpoints()[slot];
  const Peer reader = f.inspection.readers_of(*f.publisher).back();
  EmcosMessage message{};
  message.kind = EmcosMessageKind::publish;
  message.topic_dsm = publisher.block;
  message.endpoint = slot;
  message.incarnation = publisher.slot.incarnation;
  message.number = 1;
  const auto hints_of = [&](uint32_t target, uint32_t incarnation) {
    const uint64_t messages = f.far_cluster().messages;
    const uint64_t notifications = f.far_cluster().notifications;
    message.target = target;
    message.target_incarnation = incarnation;
    REQUIRE(registry.clusters().at(2).send(message));
    wait_until("the message", [&] { return f.far_cluster().messages > messages; });
    return f.far_cluster().notifications - notifications;
  };
  CHECK(hints_of(reader.slot, reader.incarnation) == 1);
  CHECK(hints_of(reader.slot, reader.incarnation + 1) == 0);
  CHECK(hints_of(slot, reader.incarnation) == 0);
  CHECK(hints_of(nothing, 0) == 2);
}

TEST_CASE("inside a cluster no eMCOS message is sent") {
  Fixture f;
  const auto near = f.process->create_subscription(on_topic("/near", keep_last(10)));
  const auto publisher = f.process->create_publisher(on_topic("/near", keep_last(10)));
  const Standstill here(f.platform, 1);
  const Standstill there(f.platform, 2);
  const auto unread = [&] {
    return messages_in(f.platform.paths().pipe(1)) + messages_in(f.platform.paths().pipe(2));
  };
  const size_t before = unread();
  publish(*publisher, 1);
  CHECK(take_all(*near) == numbers(1, 1));
  CHECK(unread() == before);
}

TEST_CASE("killed again and again under load: replaced, and nothing is lost") {
  Fixture f;
  pid_t pid = f.platform.receive_thread(2);
  uint64_t number = 0;
  for (int round = 0; round < 5; ++round) {
    f.publish_numbers(number + 1, number + 1000);
    kill(pid, SIGKILL);
    f.publish_numbers(number + 1001, number + 2000);
    number += 2000;
    pid = f.platform.receive_thread(2, pid);
  }
  f.publish_numbers(number + 1, number + 10);
  f.expect(1, number + 10);
}

TEST_CASE("killed: its successor makes each of many subscriptions look for itself") {
  TestPlatform platform;
  const auto process = platform.join();
  Inspection inspection(platform);
  constexpr size_t more_than_a_turn_visits = 400;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (size_t i = 0; i < more_than_a_turn_visits; ++i) {
    subscriptions.push_back(process->create_subscription(on_topic("/many", keep_last(1))));
  }
  const pid_t pid = platform.receive_thread(1);
  kill(pid, SIGKILL);
  platform.receive_thread(1, pid);
  wait_until("all are to look", [&] {
    return std::all_of(subscriptions.begin(), subscriptions.end(), [&](const auto & each) {
      return inspection.header_of(*each).resync.load() == 1;
    });
  });
}

TEST_CASE("a program that is being written is waited for") {
  const std::string program = "/tmp/manycore_busy_" + std::to_string(getpid());
  std::filesystem::copy("/bin/true", program);
  FileDescriptor writer(open(program.c_str(), O_WRONLY | O_CLOEXEC));
  REQUIRE(writer.get() >= 0);
  CHECK_THROWS_WITH_AS(spawn_daemon({program}), doctest::Contains("Text file busy"), Error);
  std::thread installer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    writer = FileDescriptor();
  });
  CHECK(spawn_daemon({program}) == 0);
  installer.join();
  std::filesystem::remove(program);
  CHECK_THROWS_WITH_AS(spawn_daemon({program}), doctest::Contains("No such file"), Error);
}

TEST_CASE("a receive thread keeps none of its first node's attributes") {
  TestPlatform platform;
  Child node("niced", {platform.name()});
  node.expect("joined");
  const pid_t receive_thread = platform.receive_thread(1);
  CHECK(
    getpriority(PRIO_PROCESS, static_cast<id_t>(receive_thread)) <= getpriority(PRIO_PROCESS, 0));
  CHECK(sched_getscheduler(receive_thread) == SCHED_OTHER);
  char directory[64] = {};
  const std::string link = "/proc/" + std::to_string(receive_thread) + "/cwd";
  REQUIRE(readlink(link.c_str(), directory, sizeof directory) > 0);
  CHECK(std::string(directory) == "/");
  rlimit files{};
  REQUIRE(prlimit(receive_thread, RLIMIT_NOFILE, nullptr, &files) == 0);
  CHECK(files.rlim_cur == files.rlim_max);
}

TEST_CASE("killed with unforwarded messages: its successor makes the subscriptions resync") {
  Fixture f;
  f.publish_numbers(1, 10);
  f.expect(1, 10);
  const pid_t pid = f.platform.stop_receive_thread(2);
  f.publish_numbers(11, 50);
  // Reads messages in place of the receive thread, as if it had read and not forwarded them.
  const FileDescriptor pipe = open_pipe(f.platform.paths().pipe(2));
  EmcosMessage message{};
  size_t stolen = 0;
  while (read(pipe.get(), &message, sizeof message) == static_cast<ssize_t>(sizeof message)) {
    ++stolen;
  }
  CHECK(stolen >= 39);  // the stopped read may have taken one
  kill(pid, SIGKILL);
  f.expect(11, 50);
}

TEST_CASE("stopped until its pipe overflows: the publisher continues, and nothing is lost") {
  Fixture f;
  f.publish_numbers(1, 10);
  f.expect(1, 10);
  const pid_t pid = f.platform.stop_receive_thread(2);
  constexpr uint64_t more_than_a_pipe_holds = 20'000;
  f.publish_numbers(11, more_than_a_pipe_holds);
  CHECK(f.far_cluster().pipe_overflow == 1);
  SUBCASE("and goes on") { kill(pid, SIGCONT); }
  SUBCASE("and is killed") { kill(pid, SIGKILL); }
  f.expect(11, more_than_a_pipe_holds);
  wait_until("the overflow is dealt with", [&] { return f.far_cluster().pipe_overflow == 0; });
}

TEST_CASE("stopped: a shallow subscription has the newest messages when it continues") {
  Fixture f("5");
  const pid_t pid = f.platform.stop_receive_thread(2);
  f.publish_numbers(1, 20'000);
  kill(pid, SIGCONT);
  f.expect(19'996, 20'000);
}

TEST_CASE("a receive thread whose pipe is full when the platform is removed still ends") {
  TestPlatform platform;
  pid_t pid = 0;
  {
    const auto process = platform.join(1);
    pid = platform.stop_receive_thread(1);
    const FileDescriptor pipe = open_pipe(platform.paths().pipe(1));
    EmcosMessage message{};
    message.kind = EmcosMessageKind::resync;
    while (write(pipe.get(), &message, sizeof message) > 0) {
    }
  }
  CHECK_FALSE(platform.exists());
  kill(pid, SIGCONT);  // ~TestPlatform waits for this
}

TEST_CASE("foreign bytes in the pipe: nothing crashes and nothing is lost") {
  Fixture f;
  f.publish_numbers(1, 10);
  f.expect(1, 10);
  const pid_t pid =
    f.platform.stop_receive_thread(2);  // so that it reads all of the following at once
  std::vector<uint8_t> rubbish;
  SUBCASE("a byte too many") { rubbish.assign(1, 7); }
  SUBCASE("messages of no kind") { rubbish.assign(64 * 10, 0xff); }
  SUBCASE("zeros, not aligned") { rubbish.assign(1000, 0); }
  SUBCASE("publish messages that lead nowhere") {
    EmcosMessage message{};
    message.kind = EmcosMessageKind::publish;
    for (uint64_t i = 0; i < 64; ++i) {
      message.topic_dsm = {uint64_t{1} << (i % 64) | i * 32};
      message.number = i * 0x0101'0101'0101'0101;
      message.target = nothing;
      const auto * const bytes = reinterpret_cast<const uint8_t *>(&message);
      rubbish.insert(rubbish.end(), bytes, bytes + sizeof message);
    }
  }
  const FileDescriptor pipe = open_pipe(f.platform.paths().pipe(2));
  f.publish_numbers(11, 20);
  CHECK(write(pipe.get(), rubbish.data(), rubbish.size()) == static_cast<ssize_t>(rubbish.size()));
  f.publish_numbers(21, 200);
  kill(pid, SIGCONT);
  f.expect(11, 200);
  f.publish_numbers(201, 210);
  f.expect(201, 210);
  CHECK(is_running(pid));
}

TEST_CASE("messages of an earlier publisher in the same slot are not delivered") {
  Fixture f;
  const auto place = [&](const Publisher & publisher) {
    return f.inspection.registry()
      .endpoints()[f.inspection.slot_of(publisher.gid())]
      .block.offset();
  };
  const uint64_t earlier = place(*f.publisher);
  const pid_t pid = f.platform.stop_receive_thread(2);
  f.publish_numbers(1, 10);  // in the pipe
  f.publisher.reset();
  f.expect(1, 10);  // without the receive thread, because the publisher is gone
  const auto later = f.process->create_publisher(on_topic("/x", keep_last(10)));
  REQUIRE(place(*later) == earlier);
  publish(*later, 1, 100, 2);
  const uint64_t notifications = f.far_cluster().notifications;
  kill(pid, SIGCONT);
  f.subscriber.tell("take 1 1 2");
  publish(*later, 2, 100, 2);
  wait_until("a later hint", [&] { return f.far_cluster().notifications - notifications >= 2; });
  CHECK(f.far_cluster().notifications - notifications == 2);
}
