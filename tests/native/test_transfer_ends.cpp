// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Topics that are transferred: one side leaves, or a mover dies, while a message is under way.
#include <doctest/doctest.h>

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <future>
#include <vector>

#include "transfer_of_test.hpp"

using namespace manycore;
using transfer_of_test::by;
using transfer_of_test::Fixture;
using transfer_of_test::open_pipe;
using transfer_of_test::packets_in;

namespace {

std::string pipe_of(const Fixture & f) { return f.platform.paths().data_pipe(2, 0); }

/// Publishes synchronously in another thread; returns once the message is in the pipe.
std::future<Refusal> publish_synchronously(Fixture & f, uint64_t number) {
  std::future<Refusal> refusal = std::async(std::launch::async, [&f, number] {
    return refusal_of([&] { publish(*f.publisher, number, sizeof(Payload)); });
  });
  wait_until("the message is under way", [&] { return packets_in(pipe_of(f)) != 0; });
  return refusal;
}

}  // namespace

TEST_CASE("the last subscription leaves while a synchronous message is under way: no error") {
  Fixture f(by(Transfer::message, 0, true));
  const pid_t pid = f.platform.stop_receive_thread(2);
  std::future<Refusal> refusal = publish_synchronously(f, 1);
  f.subscriber->tell("close");
  CHECK(refusal.get().text.empty());
  kill(pid, SIGCONT);
}

TEST_CASE(
  "a mover killed with a synchronous message in hand: it is lost, and nothing waits for it") {
  Fixture f(by(Transfer::message, 0, true));
  f.publish_numbers(1, 1);
  f.expect(1, 1);
  const pid_t pid = f.platform.stop_receive_thread(2);
  std::future<Refusal> refusal = publish_synchronously(f, 2);
  // What it would have read and not handled: reads it in its place.
  const FileDescriptor pipe = open_pipe(pipe_of(f));
  std::vector<uint8_t> hands(sizeof(Packet));
  REQUIRE(read(pipe.get(), hands.data(), hands.size()) == sizeof(Packet));
  kill(pid, SIGKILL);
  CHECK(refusal.get().code == ErrorCode::timeout);
  f.platform.receive_thread(2, pid);
  f.publisher.reset();
  wait_until("it is counted, and the publisher's memory free", [&] {
    f.subscriber->tell("take_all");
    return f.lost() == 1 && f.inspection().closing_endpoints() == 0;
  });
}

TEST_CASE("messages for a subscription that has left do not hold up the one after it") {
  for (const Transfer kind : {Transfer::message, Transfer::session}) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    const uint32_t cluster = kind == Transfer::message ? 2 : 1;
    const pid_t pid = f.platform.stop_receive_thread(cluster);
    f.publish_numbers(1, 5);
    f.subscriber->tell("close");
    f.publish_numbers(6, 6);  // without a subscription
    f.subscriber->tell("subscription /x 1000");
    wait_until("a match", [&] { return f.publisher->matched().current == 1; });
    const size_t mover = kind == Transfer::message ? 0 : 1;
    const std::atomic<uint64_t> & phase =
      f.inspection().registry().clusters().at(cluster).header().mover_phases[mover];
    const uint64_t before = phase.load();
    kill(pid, SIGCONT);
    wait_until("the five are handled", [&] { return phase.load() >= before + 10; });
    CHECK(f.landing().header().done.load() == 6);
    f.publish_numbers(7, 7);
    f.expect(7, 7);
    CHECK(f.lost() == 0);
  }
}

TEST_CASE("a copying thread killed before it announces a record: the subscription finds it") {
  for (const bool is_done : {false, true}) {  // killed after the mark, or after all stores
    CAPTURE(is_done);
    Fixture f(by(Transfer::session));
    const pid_t pid = f.platform.stop_receive_thread(1);
    f.publish_numbers(1, 1);
    // What it would have done: does it in its place.
    const FileDescriptor pipe = open_pipe(f.platform.paths().session_pipe(1));
    CopyRequest request{};
    REQUIRE(read(pipe.get(), &request, sizeof request) == sizeof request);
    const Landing landing = f.landing();
    Registry & registry = f.inspection().registry();
    const Cluster & own = registry.clusters().at(1);
    const GenerationEntry & only =
      own.find<TopicDsmHeader>(request.announcement.topic_dsm.offset())->generations[0];
    const auto * const data =
      own.find<uint8_t>(only.data_offset() + request.place.begin, request.place.size_bytes);
    std::memcpy(landing.find(request.place), data, request.place.size_bytes);
    landing.arrive(1);
    if (!is_done) {
      landing.header().arrived = 0;
      landing.header().done = 0;
    }
    kill(pid, SIGKILL);
    f.platform.receive_thread(1, pid);
    f.expect(1, 1);
    CHECK(f.lost() == 0);
  }
}
