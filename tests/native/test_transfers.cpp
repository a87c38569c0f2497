// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Topics that are transferred: what arrives in another cluster, and what is counted where it does
// not.
#include <doctest/doctest.h>

#include <csignal>
#include <vector>

#include "trace_of_test.hpp"
#include "transfer_of_test.hpp"
#include "transport/lifecycle/trace_control.hpp"

using namespace manycore;
using transfer_of_test::by;
using transfer_of_test::Fixture;
using transfer_of_test::kinds;
using transfer_of_test::open_pipe;
using transfer_of_test::packets_in;

namespace {

/// Says the size of each message that comes.
const Role sizes("sizes", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0), 2);
  const auto subscription = process->create_subscription(on_topic("/x", keep_last(10)));
  test.say("subscribed");
  while (true) {
    const uint32_t epoch = process->waiters().common().epoch();
    if (const std::optional<Claim> claim = subscription->claim()) {
      test.say(std::to_string(claim->size()));
    } else {
      process->waiters().common().wait(epoch, monotonic_ns() + timeout_s * ns_per_s);
    }
  }
});

/// Publishes messages larger than the pipe until one is received in time; returns its number. The
/// receiver may stand still for longer than publishing waits.
uint64_t publish_until_received(Fixture & f, uint64_t number) {
  wait_until("a message is received in time", [&] {
    const Refusal refusal = refusal_of([&] { publish(*f.publisher, number, 1'200'000); });
    REQUIRE((!refusal.code || refusal.code == ErrorCode::timeout));
    number += refusal.code ? 1 : 0;
    return !refusal.code;
  });
  return number;
}

}  // namespace

TEST_CASE("messages of every size arrive whole and in order") {
  for (const Transfer kind : kinds) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    uint64_t number = 0;
    for (const size_t size_bytes : {24, 100, 3999, 4000, 4001, 8000, 100'000, 900'000}) {
      publish(*f.publisher, ++number, size_bytes);
      f.expect(number, number);
    }
    f.publish_numbers(number + 1, number + 100);
    f.expect(number + 1, number + 100);
    CHECK(f.dropped() == 0);
    CHECK(f.lost() == 0);
  }
}

TEST_CASE("a message without bytes arrives") {
  for (const Transfer kind : kinds) {
    CAPTURE(static_cast<int>(kind));
    Fixture f(by(kind));
    f.subscriber->tell("close");
    wait_until("no match", [&] { return f.publisher->matched().current == 0; });
    Child reader("sizes", {f.platform.name()});
    reader.expect("subscribed");
    f.publisher->publish(f.publisher->draft(0), 0, 1);
    reader.expect("0");
    f.publisher->publish(f.publisher->draft(5000), 5000, 1);
    reader.expect("5000");
  }
}

TEST_CASE("inside a cluster nothing is transferred") {
  for (const Transfer kind : kinds) {
    Fixture f(by(kind));
    const auto near = f.process->create_subscription(on_topic("/x", keep_last(10)));
    f.publish_numbers(1, 5);
    CHECK(take_all(*near) == numbers(1, 5));
    f.expect(1, 5);
  }
}

TEST_CASE("a message that exceeds the topic DSM is refused with the size it needs") {
  for (const Transfer kind : kinds) {
    Fixture f(by(kind), "10", 64 << 10);
    const Refusal refusal = refusal_of([&] { publish(*f.publisher, 1, 1 << 20); });
    CHECK(refusal.code == ErrorCode::too_large);
    CHECK(refusal.says("topic_dsm_size to at least"));
    f.publish_numbers(2, 2);
    f.expect(2, 2);
  }
}

TEST_CASE("a full data pipe: the publisher goes on, and each message is taken or counted") {
  Fixture f(by(Transfer::message));
  const pid_t pid = f.platform.stop_receive_thread(2);
  f.publish_numbers(1, 800);  // the pipe holds 256
  const uint64_t dropped = f.dropped();
  CHECK(dropped >= 800 - 256);
  kill(pid, SIGCONT);
  f.expect(1, 800 - dropped);
  wait_until("the losses are counted", [&] {
    f.subscriber->tell("take_all");
    return f.lost() == dropped;
  });
  f.publish_numbers(801, 801);
  f.expect(801, 801);
  CHECK(f.lost() == dropped);
}

TEST_CASE("a message larger than the data pipe is dropped, and no part of it is delivered") {
  Fixture f(by(Transfer::message));
  const pid_t pid = f.platform.stop_receive_thread(2);
  publish(*f.publisher, 1, 2 << 20);
  CHECK(f.dropped() == 1);
  kill(pid, SIGCONT);
  wait_until(
    "the pipe is empty", [&] { return packets_in(f.platform.paths().data_pipe(2, 0)) == 0; });
  f.publish_numbers(2, 2);
  f.expect(2, 2);
  CHECK(f.lost() == 1);
  CHECK(f.dropped() == 1);  // not once more by the mover
}

TEST_CASE("synchronous: publish returns when the message is there, or says that it is not") {
  Fixture f(by(Transfer::message, 0, true));
  const uint64_t first = publish_until_received(f, 1);
  CHECK(f.landing().header().done == first);
  f.subscriber->ask("take_ordered " + std::to_string(first) + " 1");
  const pid_t pid = f.platform.stop_receive_thread(2);
  const Refusal refusal = refusal_of([&] { publish(*f.publisher, first + 1); });
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK(refusal.says("cluster 2 has not yet received the message after 100 ms"));
  CHECK(refusal.says("it may still arrive"));
  kill(pid, SIGCONT);
  f.expect(first + 1, first + 1);  // it was handed over, and comes late
  const uint64_t last = publish_until_received(f, first + 2);
  f.subscriber->ask("take_ordered " + std::to_string(last) + " 1");
}

TEST_CASE("synchronous: publish says that it had no room, and what is published again arrives") {
  Fixture f(by(Transfer::message, 0, true));
  const uint64_t first = publish_until_received(f, 1);
  f.subscriber->ask("take_ordered " + std::to_string(first) + " 1");
  const uint64_t dropped = f.dropped();
  const pid_t pid = f.platform.stop_receive_thread(2);
  const FileDescriptor pipe = open_pipe(f.platform.paths().data_pipe(2, 0));
  const std::vector<uint8_t> rubbish(sizeof(Packet), 0xff);
  while (write(pipe.get(), rubbish.data(), rubbish.size()) > 0) {
  }
  const Refusal refusal = refusal_of([&] { publish(*f.publisher, first + 1); });
  CHECK(refusal.code == ErrorCode::timeout);
  CHECK(refusal.says("cluster 2 had no room for the message within 100 ms"));
  CHECK(refusal.says("publish it again"));
  CHECK(f.dropped() == dropped + 1);
  kill(pid, SIGCONT);
  const uint64_t last = publish_until_received(f, first + 2);
  const std::string taken = f.subscriber->ask("take_ordered " + std::to_string(last) + " 1");
  CHECK(std::stoull(taken) < last - first);  // without the one that was dropped
}

TEST_CASE("packets of the highest priority are received first") {
  TestPlatform platform;
  const Configurator configurator(
    platform.name(), host_profile(),
    {{"/low", 1, 1 << 16, 0, by(Transfer::message, 0)},
     {"/high", 2, 1 << 16, 0, by(Transfer::message, 7)}});
  const auto process = platform.join(1);
  Node low_reader(platform, 2);
  Node high_reader(platform, 2);
  low_reader.tell("subscription /low 100");
  high_reader.tell("subscription /high 100");
  auto low = process->create_publisher(on_topic("/low", keep_last(100)));
  auto high = process->create_publisher(on_topic("/high", keep_last(100)));
  publish(*low, 1);
  publish(*high, 1);
  low_reader.tell("take 1 1 1");
  high_reader.tell("take 1 1 1");
  Inspection inspection(platform);
  const uint32_t low_slot = inspection.slot_of(low->gid());
  start_trace(inspection.registry(), {{}, {}, 4096});
  const pid_t pid = platform.stop_receive_thread(2);
  for (uint64_t number = 2; number <= 40; ++number) {
    publish(*low, number);
  }
  for (uint64_t number = 2; number <= 40; ++number) {
    publish(*high, number);
  }
  kill(pid, SIGCONT);
  low_reader.tell("take 2 40 1");
  high_reader.tell("take 2 40 1");
  stop_trace(inspection.registry());
  std::vector<uint32_t> arrivals;
  TraceSaver saver(inspection.registry());
  for (const ProcessTrace & traced : saver.processes()) {
    for (const ThreadTrace & thread : traced.threads) {
      for (const TraceEvent & event : thread.events) {
        if (event.kind == TraceKind::arrive) {
          arrivals.push_back(event.endpoint);
        }
      }
    }
  }
  saver.finish();
  REQUIRE(arrivals.size() == 78);
  // The mover was stopped in a wait or with one batch in hand.
  CHECK(std::count(arrivals.begin(), arrivals.begin() + 39, low_slot) <= 16);
  low.reset();
  high.reset();
}

TEST_CASE("a transferred topic takes no publisher that keeps a history") {
  Fixture f(by(Transfer::async));
  const Refusal refusal =
    refusal_of([&] { f.process->create_publisher(on_topic("/x", transient_local(1))); });
  CHECK(refusal.code == ErrorCode::unsupported);
  CHECK(refusal.says("durability transient_local"));
}

TEST_CASE("a transferred topic needs a fixed size") {
  TestPlatform platform;
  const Refusal refusal = refusal_of([&] {
    const Configurator configurator(
      platform.name(), host_profile(), {{"/x", 1, 0, 0, by(Transfer::async)}});
  });
  CHECK(refusal.code == ErrorCode::invalid_argument);
  CHECK(refusal.says("expected a topic_dsm_size"));
}

TEST_CASE("RELIABLE and KEEP_ALL: a subscription that takes nothing holds the publisher up") {
  for (const Transfer kind : {Transfer::session, Transfer::async}) {
    Fixture f(by(kind), "keep_all", 4096, keep_all());
    uint64_t number = 0;
    const auto publish_until_refused = [&] {
      while (true) {
        ++number;
        const Refusal refusal = refusal_of([&] { publish(*f.publisher, number, 1000); });
        if (refusal.code == ErrorCode::timeout) {
          return --number;
        }
      }
    };
    const uint64_t held = publish_until_refused();
    CHECK(held >= 3);
    f.expect(1, held);
    CHECK(f.lost() == 0);
  }
}
