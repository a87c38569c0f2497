// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// What the tools see of large messages: copies, and the memory that readers hold.
#include <doctest/doctest.h>

#include <optional>
#include <vector>

#include "drivers_of_test.hpp"
#include "transport/topic_dsm/chunk_table.hpp"

using namespace drivers_of_test;

namespace {

constexpr size_t large = 100'000;

std::optional<Hold> hold_next(Subscription & subscription) {
  auto claim = subscription.claim();
  REQUIRE(claim);
  return claim->hold();
}

uint64_t held_bytes(const Fixture & f, const Gid & endpoint) {
  for (const Activity & row : f.process->graph().activity()) {
    if (row.endpoint == endpoint_in(endpoint)) {
      return row.held_bytes;
    }
  }
  FAIL("no such endpoint");
  return 0;
}

}  // namespace

TEST_CASE("activity tells what readers hold: each chunk once") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(4));
  const auto other = f.publisher(keep_last(4));
  const auto first = f.subscription(keep_last(4));
  const auto second = f.subscription(keep_last(4));
  publish(*publisher, 1, large);
  publish(*other, 2, large);
  CHECK(held_bytes(f, publisher->gid()) == 0);
  auto of_first = hold_next(*first);
  auto of_second = hold_next(*second);
  const uint64_t one = chunk::bytes_for(large);
  CHECK(held_bytes(f, publisher->gid()) == one);
  CHECK(held_bytes(f, other->gid()) == 0);
  CHECK(held_bytes(f, first->gid()) == one);
  const auto next = hold_next(*first);
  CHECK(held_bytes(f, other->gid()) == one);
  CHECK(held_bytes(f, first->gid()) == 2 * one);
  const Graph & graph = f.process->graph();
  CHECK(graph.activity_of(graph.endpoints(), HeldMemory::counted).at(0).held_bytes == one);
  CHECK(graph.activity_of(graph.endpoints(), HeldMemory::skipped).at(0).held_bytes == 0);
  of_first.reset();
  CHECK(held_bytes(f, publisher->gid()) == one);
  of_second.reset();
  CHECK(held_bytes(f, publisher->gid()) == 0);
  CHECK(held_bytes(f, first->gid()) == one);
}

TEST_CASE("activity counts messages that were written and read in place") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(4));
  const auto subscription = f.subscription(keep_last(4));
  publish(*publisher, 1, large);
  auto loan = publisher->lend(large);
  REQUIRE(loan);
  Payload{1, 2, large}.write(loan->data());
  publisher->publish(std::move(*loan), large, 1);
  for (int i = 0; i < 2; ++i) {
    auto claim = subscription->claim();
    REQUIRE(claim);
    if (i == 0) {
      claim->count_in_place();
    }
  }
  const std::vector<Activity> rows = f.process->graph().activity();
  CHECK(rows.at(0).counters.in_place == 1);
  CHECK(rows.at(1).counters.in_place == 1);
}
