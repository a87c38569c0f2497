// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Hints name records by the low bits of their numbers. What is delivered and counted past a whole
// period of them: of a topic, and of a server whose replies to others lie between those to a
// client.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/queue/hint.hpp"

using namespace manycore;

namespace {

constexpr int64_t period = int64_t{Hint::number_mask} + 1;

struct Fixture {
  std::unique_ptr<Subscription> client(uint32_t depth) const {
    return process->create_subscription(replies(depth));
  }
  static EndpointSpec replies(uint32_t depth) {
    EndpointSpec spec = on_topic("/service", keep_last(depth));
    spec.role = EndpointRole::reply;
    return spec;
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
};

void send(Publisher & server, const Subscription & client, int64_t number) {
  constexpr size_t size_bytes = 8;
  server.publish(server.draft(size_bytes), size_bytes, realtime_ns(), {client.gid(), number});
}

std::vector<int64_t> received(Subscription & client) {
  std::vector<int64_t> numbers;
  while (const std::optional<Claim> claim = client.claim()) {
    numbers.push_back(claim->info().correlation.number);
  }
  return numbers;
}

}  // namespace

TEST_CASE("a topic past a period: the newest messages arrive, the others are counted") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(1)));
  const auto stuck = f.process->create_subscription(on_topic("/x", keep_last(3)));
  constexpr auto all = static_cast<uint64_t>(period) + 2;
  for (uint64_t number = 1; number <= all; ++number) {
    publish(*publisher, number);
  }
  CHECK(take_all(*stuck) == numbers(all - 2, all));
  CHECK(stuck->lost() == all - 3);
  publish(*publisher, all + 1);
  CHECK(take_all(*stuck) == numbers(all + 1, all + 1));
  CHECK(stuck->lost() == all - 3);
}

TEST_CASE("a client gets its replies although a period of others lies between them") {
  Fixture f;
  const auto server = f.process->create_publisher(Fixture::replies(1));
  const auto client = f.client(10);
  const auto other = f.client(1);
  send(*server, *client, 1);
  for (int64_t number = 1; number <= period + 1; ++number) {
    send(*server, *other, number);
  }
  send(*server, *client, 2);
  CHECK(received(*client) == std::vector<int64_t>{1, 2});
  CHECK(client->lost() == 0);
  send(*server, *client, 3);
  CHECK(received(*client) == std::vector<int64_t>{3});
  CHECK(received(*other) == std::vector<int64_t>{period + 1});
  CHECK(other->lost() == static_cast<uint64_t>(period));
}

TEST_CASE("a client whose reply was displaced gets each later one, however many there are") {
  Fixture f;
  const auto server = f.process->create_publisher(Fixture::replies(1));
  const auto client = f.client(1);
  send(*server, *client, 1);
  send(*server, *client, 2);  // displaces it
  CHECK(received(*client) == std::vector<int64_t>{2});
  CHECK(client->lost() == 1);
  int64_t missed = 0;
  for (int64_t number = 3; number <= period + 10; ++number) {
    send(*server, *client, number);
    missed += client->claim() ? 0 : 1;
  }
  CHECK(missed == 0);
  CHECK(client->lost() == 1);
}
