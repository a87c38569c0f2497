// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The subscriber queue in a single thread.
#include <doctest/doctest.h>

#include <vector>

#include "bare_queue.hpp"

using namespace manycore;

namespace {

void push_numbers(BareQueue & queue, uint64_t first, uint64_t last) {
  for (uint64_t number = first; number <= last; ++number) {
    queue.push({0, 0, number});
  }
}

std::vector<uint64_t> pop_all(BareQueue & queue) {
  std::vector<uint64_t> popped;
  while (const std::optional<Hint> hint = queue.pop()) {
    popped.push_back(hint->number);
  }
  return popped;
}

}  // namespace

TEST_CASE("pushed hints are popped in order, with all their fields") {
  BareQueue queue(8, false);
  queue.push({3, 5, 7});
  queue.push({Hint::publisher_mask, Hint::incarnation_mask, Hint::number_mask});
  const Hint first = queue.pop().value();
  CHECK(first.publisher == 3);
  CHECK(first.incarnation == 5);
  CHECK(first.number == 7);
  const Hint second = queue.pop().value();
  CHECK(second.publisher == Hint::publisher_mask);
  CHECK(second.incarnation == Hint::incarnation_mask);
  CHECK(second.number == Hint::number_mask);
  CHECK_FALSE(queue.pop());
}

TEST_CASE("numbers and incarnations beyond their bits are cut, and touch nothing else") {
  BareQueue queue(1, false);
  queue.push({2, Hint::incarnation_mask + 2, Hint::number_mask + 4});
  const Hint hint = queue.pop().value();
  CHECK(hint.publisher == 2);
  CHECK(hint.incarnation == 1);
  CHECK(hint.number == 3);
}

TEST_CASE("capacity is the depth, even if that is not a power of two") {
  for (const uint32_t depth : {1u, 2u, 3u, 5u, 8u, 10u}) {
    CAPTURE(depth);
    BareQueue queue(depth, false);
    push_numbers(queue, 1, depth);
    CHECK(queue.displaced() == 0);
    push_numbers(queue, depth + 1, depth + 4);
    CHECK(queue.displaced() == 4);
    const std::vector<uint64_t> popped = pop_all(queue);
    REQUIRE(popped.size() == depth);
    CHECK(popped.front() == 5);
    CHECK(popped.back() == depth + 4);
  }
}

TEST_CASE("a full KEEP_ALL queue displaces nothing and asks for a resync") {
  BareQueue queue(4, true);
  push_numbers(queue, 1, 4);
  CHECK(queue.header().resync == 0);
  push_numbers(queue, 5, 6);
  CHECK(queue.header().resync == 1);
  CHECK(queue.displaced() == 0);
  CHECK(pop_all(queue) == std::vector<uint64_t>{1, 2, 3, 4});
}

TEST_CASE("empty() says whether pop() finds something") {
  BareQueue queue(2, false);
  CHECK(queue.empty());
  queue.push({});
  CHECK_FALSE(queue.empty());
  queue.pop();
  CHECK(queue.empty());
}

TEST_CASE("positions go through all laps of a slot's tag, and through zero") {
  constexpr uint64_t laps = 65536 + 3;
  for (const uint32_t depth : {1u, 3u}) {
    BareQueue queue(depth, false);
    uint64_t wrong = 0;
    for (uint64_t number = 1; number <= laps * 4; number += depth) {
      push_numbers(queue, number, number + depth - 1);
      wrong += pop_all(queue).size() == depth && queue.empty() ? 0 : 1;
    }
    CHECK(wrong == 0);
    CHECK(queue.displaced() == 0);
  }
}

TEST_CASE("a pusher that died after its exchange on the slot is helped") {
  BareQueue queue(4, false);
  queue.push({0, 0, 1});
  SubscriptionHeader & header = queue.header();
  const uint64_t tail = header.tail;
  const subscriber_queue::Slots slots(header);
  slots.at(tail) = subscriber_queue::encode(slots.lap(tail), {0, 0, 2});
  SUBCASE("by the next pusher") {
    queue.push({0, 0, 3});
    CHECK(header.tail == tail + 2);
    CHECK(pop_all(queue) == std::vector<uint64_t>{1, 2, 3});
  }
  SUBCASE("by the popper") {
    CHECK(pop_all(queue) == std::vector<uint64_t>{1, 2});
    CHECK(header.tail == tail + 1);
    CHECK(header.head == header.tail);
  }
}
