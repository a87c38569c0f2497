// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Topics that are transferred: what becomes of memory, messages and sessions when one of the
// processes is killed or stopped, and when there is no room.
#include <doctest/doctest.h>

#include <unistd.h>

#include <csignal>
#include <vector>

#include "transfer_of_test.hpp"
#include "transport/lifecycle/lifecycle.hpp"

using namespace manycore;
using transfer_of_test::by;
using transfer_of_test::Fixture;
using transfer_of_test::kinds;
using transfer_of_test::open_pipe;
using transfer_of_test::packets_in;

namespace {

/// Subscribes to the topics /s1, /s2 ... in cluster 2, up to a number: "ok", or the error.
const Role subscribes("subscribes", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0), 2);
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (int i = 1; i <= std::stoi(arguments.at(1)); ++i) {
    const Refusal refusal = refusal_of([&] {
      subscriptions.push_back(
        process->create_subscription(on_topic("/s" + std::to_string(i), keep_last(1))));
    });
    test.say(refusal.code ? refusal.text : "ok");
  }
  test.hear();
});

/// What fills the landings of the fixture's publisher: a thread of this cluster's receive thread,
/// and the pipe that it reads.
struct Mover {
  uint32_t cluster;
  std::string pipe;
  size_t message_bytes;
};

Mover mover_of(const Fixture & f, Transfer kind) {
  const PlatformPaths paths = f.platform.paths();
  return kind == Transfer::message ? Mover{2, paths.data_pipe(2, 0), sizeof(Packet)}
                                   : Mover{1, paths.session_pipe(1), sizeof(CopyRequest)};
}

std::vector<TopicConfiguration> nine_topics(Transfer kind) {
  std::vector<TopicConfiguration> topics;
  for (uint32_t i = 1; i <= 9; ++i) {
    topics.push_back({"/s" + std::to_string(i), i, 8192, 0, by(kind)});
  }
  return topics;
}

}  // namespace

TEST_CASE("a publisher killed between two packets: nothing of the message is delivered") {
  for (const size_t packets : {2, 5, 11}) {  // of the first message one, of the second up to 11
    CAPTURE(packets);
    Fixture f(by(Transfer::message));
    const std::string pipe = f.platform.paths().data_pipe(2, 0);
    const pid_t pid = f.platform.stop_receive_thread(2);
    f.publisher.reset();
    {
      SteppedChild child("sends", {f.platform.name(), "40000"});
      while (packets_in(pipe) < packets) {
        child.run_to_system_call();
      }
      REQUIRE_FALSE(child.finished());
      child.kill();
    }
    REQUIRE(packets_in(pipe) == packets);
    kill(pid, SIGCONT);
    f.subscriber->tell("take 1 1 2");
    wait_until("the dead publisher's memory is free", [&] {
      f.subscriber->tell("take_all");
      return f.inspection().live_processes() == 2 && f.inspection().closing_endpoints() == 0;
    });
    f.publisher = f.process->create_publisher(on_topic("/x", keep_last(10)));
    wait_until("a match", [&] { return f.publisher->matched().current == 1; });
    f.publish_numbers(1, 3);
    f.expect(1, 3);
  }
}

TEST_CASE("a publisher killed between two packets: freed though each take finds a message") {
  Fixture f(by(Transfer::message));
  const std::string pipe = f.platform.paths().data_pipe(2, 0);
  const pid_t pid = f.platform.stop_receive_thread(2);
  f.publisher.reset();
  {
    SteppedChild child("sends", {f.platform.name(), "40000"});
    while (packets_in(pipe) < 5) {
      child.run_to_system_call();
    }
    child.kill();
  }
  // An executor takes when there is something to take. What the death reveals comes too early: the
  // first message is still under way.
  CHECK(f.subscriber->ask("look") == "nothing");
  kill(pid, SIGCONT);
  CHECK(f.subscriber->ask("look") == "1");
  wait_until("the dead publisher's memory is free, and the second message counted as lost", [&] {
    return f.inspection().closing_endpoints() == 0 && f.lost() == 1;
  });
}

TEST_CASE("a mover killed with messages in hand: those are counted as lost, others arrive") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    f.publish_numbers(1, 10);
    f.expect(1, 10);
    const Mover mover = mover_of(f, kind);
    const pid_t pid = f.platform.stop_receive_thread(mover.cluster);
    f.publish_numbers(11, 50);
    // What it would have read and not handled: reads it in its place.
    const FileDescriptor pipe = open_pipe(mover.pipe);
    std::vector<uint8_t> hands(mover.message_bytes * 5);
    REQUIRE(read(pipe.get(), hands.data(), hands.size()) > 0);
    kill(pid, SIGKILL);
    f.platform.receive_thread(mover.cluster, pid);
    wait_until("the successor has taken over", [&] {
      const LandingHeader & landing = f.landing().header();
      return landing.done == landing.handed;
    });
    f.subscriber->ask("take_ordered 50 1");
    f.publish_numbers(51, 60);
    f.expect(51, 60);
    CHECK(f.lost() >= 5);
    CHECK(f.lost() <= 6);  // one may have been in the hands of the stopped read
  }
}

TEST_CASE("a mover killed with the newest messages in hand: its successor gives them up") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    f.publisher = f.process->create_publisher(on_topic("/x", keep_last(1000)));
    f.publish_numbers(1, 10);
    f.expect(1, 10);
    const Mover mover = mover_of(f, kind);
    const pid_t pid = f.platform.stop_receive_thread(mover.cluster);
    f.publish_numbers(11, 14);
    // What it would have read and not handled: reads it in its place.
    const FileDescriptor pipe = open_pipe(mover.pipe);
    std::vector<uint8_t> hands(sizeof(Packet));
    while (read(pipe.get(), hands.data(), hands.size()) > 0) {
    }
    kill(pid, SIGKILL);
    f.platform.receive_thread(mover.cluster, pid);
    wait_until("all are counted as lost", [&] {
      f.subscriber->tell("take_all");
      return f.lost() == 4;
    });
    f.publish_numbers(15, 20);
    f.expect(15, 20);
  }
}

TEST_CASE("a mover killed in the middle of a message: the rest of it is not delivered") {
  constexpr size_t three_packets = 10'000;
  Fixture f(by(Transfer::message));
  f.publish_numbers(1, 10);
  f.expect(1, 10);
  const pid_t pid = f.platform.stop_receive_thread(2);
  f.publish_numbers(11, 20, three_packets);
  // What it would have read and not handled: reads it in its place.
  const FileDescriptor pipe = open_pipe(f.platform.paths().data_pipe(2, 0));
  std::vector<uint8_t> hands(sizeof(Packet));
  REQUIRE(read(pipe.get(), hands.data(), hands.size()) == sizeof(Packet));
  kill(pid, SIGKILL);
  f.platform.receive_thread(2, pid);
  wait_until("the successor has taken over", [&] {
    const LandingHeader & landing = f.landing().header();
    return landing.done == landing.handed;
  });
  f.subscriber->ask("take_ordered 20 1");
  f.publish_numbers(21, 30);
  f.expect(21, 30);
  CHECK(f.lost() >= 1);
  CHECK(f.lost() <= 2);  // one may have been in the hands of the stopped read
}

TEST_CASE("stopped: a shallow subscription has the newest when the mover goes on") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    Fixture f(by(kind), "5");
    const pid_t pid = f.platform.stop_receive_thread(kind == Transfer::message ? 2 : 1);
    f.publish_numbers(1, 200);
    kill(pid, SIGCONT);
    wait_until("all have arrived", [&] { return f.landing().arrived() == 200; });
    f.publish_numbers(201, 201);
    wait_until("the last has arrived", [&] { return f.landing().arrived() == 201; });
    f.subscriber->ask("take_ordered 201 1");
    wait_until("all are accounted for", [&] { return f.lost() == 196; });
  }
}

TEST_CASE("the pipe stays full of others' packets: each drop is told") {
  for (const Qos & qos : {keep_last(10), keep_all()}) {
    Fixture f(by(Transfer::message), "keep_all", transfer_of_test::dsm_bytes, qos);
    const pid_t pid = f.platform.stop_receive_thread(2);
    const FileDescriptor pipe = open_pipe(f.platform.paths().data_pipe(2, 0));
    const std::vector<uint8_t> rubbish(sizeof(Packet), 0xff);
    while (write(pipe.get(), rubbish.data(), rubbish.size()) > 0) {
    }
    for (uint64_t number = 1; number <= 3; ++number) {
      f.publish_numbers(number, number);
      CHECK(f.subscriber->ask("look") == "nothing");
      CHECK(f.lost() == number);
    }
    CHECK(f.dropped() == 3);
    kill(pid, SIGCONT);
    wait_until(
      "there is room again", [&] { return packets_in(f.platform.paths().data_pipe(2, 0)) == 0; });
    f.publish_numbers(4, 6);
    f.expect(4, 6);
  }
}

TEST_CASE("strangers in the pipes: nothing crashes, and what follows arrives") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    Fixture f(by(kind));
    f.publish_numbers(1, 3);
    f.expect(1, 3);
    const Mover mover = mover_of(f, kind);
    const FileDescriptor pipe = open_pipe(mover.pipe);
    for (const uint8_t value : {0x00, 0x01, 0x7f, 0xff}) {
      const std::vector<uint8_t> rubbish(mover.message_bytes, value);
      REQUIRE(write(pipe.get(), rubbish.data(), rubbish.size()) > 0);
    }
    f.publish_numbers(4, 6);
    f.expect(4, 6);
  }
}

TEST_CASE("a killed subscriber: its landing goes, and a later one has another") {
  for (const Transfer kind : kinds) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    f.publish_numbers(1, 5);
    f.expect(1, 5);
    REQUIRE(f.inspection().used_bytes(2) > f.used_before + transfer_of_test::dsm_bytes);
    f.subscriber->kill();
    wait_until("the landing is free", [&] {
      f.publish_numbers(6, 6);
      return f.inspection().used_bytes(2) < transfer_of_test::dsm_bytes;
    });
    f.subscriber.reset();
    f.subscriber.emplace(f.platform, 2);
    f.subscriber->tell("subscription /x 100");
    wait_until("a match", [&] { return f.publisher->matched().current == 1; });
    f.publish_numbers(7, 9);
    f.expect(7, 9);
  }
}

TEST_CASE("a cluster killed with its receive thread: what its sessions had not moved is lost") {
  Fixture f(by(Transfer::session));
  f.publisher.reset();
  Node publisher(f.platform, 3);
  publisher.tell("publisher /x 100");
  publisher.tell("matched 1");
  publisher.tell("publish 1 10 1000");
  f.subscriber->tell("take 1 10 " + publisher.id());
  const pid_t pid = f.platform.stop_receive_thread(3);
  publisher.tell("publish 11 30 1000");
  publisher.kill();
  kill(pid, SIGKILL);
  wait_until("the rest is counted as lost, and all memory free", [&] {
    f.subscriber->tell("take_all");
    return f.lost() == 20 && f.inspection().closing_endpoints() == 0;
  });
}

TEST_CASE("what a publisher hands over stays in the pipe when it is killed at once") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    CAPTURE(static_cast<int>(kind));
    TestPlatform platform;
    const Configurator configurator(
      platform.name(), host_profile(), {{"/x", 1, transfer_of_test::dsm_bytes, 0, by(kind)}});
    const auto process = platform.join(1);
    const auto subscription = process->create_subscription(on_topic("/x", keep_last(1)));
    const auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
    const std::vector<pid_t> receive_threads = platform.receive_threads();
    REQUIRE(receive_threads.size() == 1);
    const PlatformPaths paths = platform.paths();
    const bool is_message = kind == Transfer::message;
    CHECK(has_open(
      receive_threads.front(), is_message ? paths.data_pipe(1, 0) : paths.session_pipe(1)));
  }
}

TEST_CASE("a killed publisher: its landing goes, once all is taken") {
  for (const Transfer kind : kinds) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    f.publisher.reset();
    Node publisher(f.platform, 1);
    publisher.tell("publisher /x 100");
    publisher.tell("matched 1");
    publisher.tell("publish 1 20 1000");
    const std::string writer = publisher.id();
    publisher.kill();
    f.subscriber->tell("take 1 20 " + writer);
    wait_until("the landing is free", [&] {
      f.subscriber->tell("take_all");
      return f.inspection().used_bytes(2) < transfer_of_test::dsm_bytes;
    });
  }
}

TEST_CASE("a ninth session is refused with the names of the eight, and comes back with its peer") {
  TestPlatform platform;
  const Configurator configurator(platform.name(), host_profile(), nine_topics(Transfer::session));
  const auto process = platform.join(1);
  const uint32_t node = process->add_node("talker", "/", "/");
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (int i = 1; i <= 9; ++i) {
    EndpointSpec spec = on_topic("/s" + std::to_string(i), keep_last(1));
    spec.node = node;
    publishers.push_back(process->create_publisher(spec));
  }
  {
    Child reader("subscribes", {platform.name(), "9"});
    for (int i = 1; i <= 8; ++i) {
      reader.expect("ok");
    }
    const std::string refusal = reader.hear();
    CHECK(refusal.find("no session for '/s9': cluster 1 to others has 8 already") == 0);
    for (int i = 1; i <= 8; ++i) {
      const std::string name = "/s" + std::to_string(i) + " of talker from cluster 1 to 2";
      CHECK(refusal.find(name) != std::string::npos);
    }
    reader.kill();
  }
  Inspection inspection(platform);
  wait_until("the sessions are back", [&] {
    return inspection.live_processes() == 1 && inspection.closing_endpoints() == 0;
  });
  Child again("subscribes", {platform.name(), "8"});
  for (int i = 1; i <= 8; ++i) {
    again.expect("ok");
  }
  publishers.clear();
}

TEST_CASE("a cluster without room for a landing refuses the subscription and names the sizes") {
  TestPlatform platform;
  Profile profile = host_profile();
  profile.smem_bytes = 1 << 20;
  const Configurator configurator(
    platform.name(), profile,
    {{"/s1", 1, 600 << 10, 0, by(Transfer::async)}, {"/s2", 2, 600 << 10, 0, by(Transfer::async)}});
  const auto process = platform.join(1);
  auto first = process->create_publisher(on_topic("/s1", keep_last(1)));
  Node elsewhere(platform, 3);
  elsewhere.tell("publisher /s2 1");
  Child reader("subscribes", {platform.name(), "2"});
  reader.expect("ok");
  const std::string refusal = reader.hear();
  CHECK(refusal.find("cluster 2 has no room for") == 0);
  CHECK(refusal.find("topic_dsm_size") != std::string::npos);
  publish(*first, 1);
  first.reset();
}
