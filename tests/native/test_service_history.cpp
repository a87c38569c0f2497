// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What a server keeps of requests and a client of replies: their depth, as for topics.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"

using namespace manycore;

namespace {

constexpr EndpointRole roles[] = {EndpointRole::request, EndpointRole::reply};
constexpr uint32_t fixed_bytes = 4096;  ///< of the topic DSM of /fixed

struct Fixture {
  TestPlatform platform;
  Configurator configurator{platform.name(), host_profile(), {{"/fixed", 1, fixed_bytes, 0}}};
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};

  static EndpointSpec spec(EndpointRole role, const Qos & qos, const char * service) {
    EndpointSpec spec = on_topic(service, qos);
    spec.role = role;
    return spec;
  }
  std::unique_ptr<Publisher> sender(
    EndpointRole role, const Qos & qos = keep_last(10), const char * service = "/service") {
    return process->create_publisher(spec(role, qos, service));
  }
  std::unique_ptr<Subscription> receiver(
    EndpointRole role, const Qos & qos, const char * service = "/service") {
    return process->create_subscription(spec(role, qos, service));
  }
};

void send(Publisher & sender, const Subscription & client, int64_t first, int64_t last) {
  constexpr size_t size_bytes = 100;
  for (int64_t number = first; number <= last; ++number) {
    sender.publish(sender.draft(size_bytes), size_bytes, realtime_ns(), {client.gid(), number});
  }
}

std::vector<uint64_t> received_numbers(Subscription & receiver) {
  std::vector<uint64_t> numbers;
  while (const std::optional<Claim> claim = receiver.claim()) {
    numbers.push_back(static_cast<uint64_t>(claim->info().correlation.number));
  }
  return numbers;
}

}  // namespace

TEST_CASE("a reply goes to the client that asked, and to no other") {
  Fixture f;
  const auto server = f.sender(EndpointRole::reply);
  const auto asking = f.receiver(EndpointRole::reply, keep_last(10));
  const auto other = f.receiver(EndpointRole::reply, keep_last(10));
  send(*server, *asking, 42, 42);
  CHECK_FALSE(other->has_data());
  CHECK(received_numbers(*asking) == numbers(42, 42));
  send(*server, *other, 43, 43);
  CHECK_FALSE(asking->has_data());
  CHECK(received_numbers(*other) == numbers(43, 43));
}

TEST_CASE("the last requests and replies stay, up to the depth; the others are counted as lost") {
  for (const EndpointRole role : roles) {
    for (const uint32_t depth : {1, 2, 3, 5, 40}) {
      CAPTURE(static_cast<int>(role));
      CAPTURE(depth);
      Fixture f;
      const auto sender = f.sender(role);
      const auto receiver = f.receiver(role, keep_last(depth));
      send(*sender, *receiver, 1, 200);
      CHECK(receiver->lost() == 200 - depth);
      CHECK(received_numbers(*receiver) == numbers(201 - depth, 200));
      send(*sender, *receiver, 201, 201);
      CHECK(received_numbers(*receiver) == numbers(201, 201));
      CHECK(receiver->lost() == 200 - depth);
    }
  }
}

TEST_CASE("KEEP_ALL: requests and replies are not displaced") {
  for (const EndpointRole role : roles) {
    Fixture f;
    const auto sender = f.sender(role, keep_all());
    const auto receiver = f.receiver(role, keep_all());
    send(*sender, *receiver, 1, 900);
    CHECK(received_numbers(*receiver) == numbers(1, 900));
    CHECK(receiver->lost() == 0);
  }
}

TEST_CASE("KEEP_ALL: a message without room is refused after the bound, and nothing is lost") {
  for (const EndpointRole role : roles) {
    Fixture f;
    const Standstill receive_thread(f.platform, 1);
    const auto sender = f.sender(role, keep_all(), "/fixed");
    const auto receiver = f.receiver(role, keep_all(), "/fixed");
    int64_t last = 0;
    const Refusal refusal = refusal_of([&] {
      for (; last < 1000; ++last) {
        send(*sender, *receiver, last + 1, last + 1);
      }
    });
    CHECK(refusal.code == ErrorCode::timeout);
    REQUIRE(last > 4);
    CHECK(received_numbers(*receiver) == numbers(1, static_cast<uint64_t>(last)));
    CHECK(receiver->lost() == 0);
  }
}

TEST_CASE("a client that takes nothing keeps no reply from another, and little memory") {
  Fixture f;
  const Standstill receive_thread(f.platform, 1);
  const auto server = f.sender(EndpointRole::reply);
  const auto stuck = f.receiver(EndpointRole::reply, keep_last(2));
  const auto busy = f.receiver(EndpointRole::reply, keep_last(2));
  for (int64_t number = 1; number <= 1000; ++number) {
    send(*server, *stuck, number, number);
    send(*server, *busy, number, number);
    REQUIRE(received_numbers(*busy) == numbers(number, number));
  }
  CHECK(f.inspection.generations_of(*server) == 1);
  CHECK(busy->lost() == 0);
  CHECK(stuck->lost() == 998);
  CHECK(received_numbers(*stuck) == numbers(999, 1000));
  CHECK(stuck->lost() == 998);
}

TEST_CASE("messages that the topic DSM overwrites are counted where they are missed") {
  for (const EndpointRole role : roles) {
    for (const bool by_hints : {false, true}) {  // else by a scan of the topic DSM
      Fixture f;
      const auto sender = f.sender(role, keep_last(10), "/fixed");
      const auto receiver = f.receiver(role, keep_last(100), "/fixed");
      send(*sender, *receiver, 0, by_hints ? 0 : -1);
      REQUIRE(received_numbers(*receiver).size() == (by_hints ? 1 : 0));
      send(*sender, *receiver, 1, 200);
      const std::vector<uint64_t> received = received_numbers(*receiver);
      CHECK(received.size() <= fixed_bytes / 100);
      CHECK(received == numbers(201 - received.size(), 200));
      CHECK(receiver->lost() + received.size() == 200);
    }
  }
}

TEST_CASE("replies are delivered or counted, whatever a scan of the topic DSM finds of them") {
  Fixture f;
  const auto server = f.sender(EndpointRole::reply);
  const auto client = f.receiver(EndpointRole::reply, keep_last(5));
  const auto other = f.receiver(EndpointRole::reply, keep_last(5));
  SubscriptionHeader & header = f.inspection.header_of(*client);
  send(*server, *client, 1, 3);
  header.resync.store(1);
  CHECK(client->arrivals() == 3);  // arrivals() scans: the replies are in its backlog
  send(*server, *other, 1, 100);
  send(*server, *client, 4, 6);
  CHECK(received_numbers(*client) == numbers(2, 6));
  CHECK(client->lost() == 1);
  send(*server, *client, 7, 16);
  header.resync.store(1);  // hints displaced by now stay displaced
  CHECK(received_numbers(*client) == numbers(12, 16));
  CHECK(client->lost() == 6);
}

TEST_CASE("the topic DSM of a server that is gone does not wait for replies that are dropped") {
  Fixture f;
  auto gone = f.sender(EndpointRole::reply);
  const auto server = f.sender(EndpointRole::reply);
  const auto client = f.receiver(EndpointRole::reply, keep_last(2));
  const auto other = f.receiver(EndpointRole::reply, keep_last(2));
  send(*gone, *client, 1, 2);
  send(*gone, *other, 1, 1);
  CHECK(received_numbers(*other) == numbers(1, 1));
  send(*server, *client, 3, 4);
  gone.reset();
  CHECK(received_numbers(*client) == numbers(3, 4));
  CHECK(client->lost() == 2);
  f.inspection.wait_until_swept();
}
