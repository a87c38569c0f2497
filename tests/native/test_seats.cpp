// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Seats: what a publisher keeps of each reader. Their orders of stores: docs/model/seats.pml.
#include <doctest/doctest.h>

#include "drivers_of_test.hpp"
#include "transport/topic_dsm/seat_table.hpp"
#include "waiting.hpp"

using namespace drivers_of_test;

namespace {

uint32_t given_seats(Fixture & f, const Publisher & publisher) {
  uint32_t count = 0;
  visit_seats(
    f.inspection.registry().clusters().at(1), f.inspection.header_of(publisher), [&](Seat & seat) {
      count += seat.owner.load() != 0 ? 1 : 0;
      return false;
    });
  return count;
}

Seat * seat_of(Fixture & f, const Publisher & publisher, const Subscription & subscription) {
  const uint32_t slot = f.inspection.slot_of(subscription.gid());
  const uint32_t incarnation = f.inspection.registry().endpoints()[slot].slot.incarnation;
  return find_seat(
    f.inspection.registry().clusters().at(1), f.inspection.header_of(publisher),
    endpoint_word(slot, incarnation));
}

}  // namespace

TEST_CASE("a reader gets its seat with the first record that it is owed, not before") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto first = f.subscription(keep_last(10));
  CHECK(given_seats(f, *publisher) == 0);
  publish(*publisher, 1);
  REQUIRE(seat_of(f, *publisher, *first) != nullptr);
  CHECK(seat_of(f, *publisher, *first)->taken == 0);
  const auto late = f.subscription(keep_last(10));
  CHECK(seat_of(f, *publisher, *late) == nullptr);
  publish(*publisher, 2);
  CHECK(seat_of(f, *publisher, *late)->taken == 1);
  CHECK(seat_of(f, *publisher, *late)->accounted == 1);
  CHECK(take_all(*late) == numbers(2, 2));
  CHECK(seat_of(f, *publisher, *late)->taken == 2);
  CHECK(take_all(*first) == numbers(1, 2));
  CHECK(first->lost() == 0);
}

TEST_CASE("the seat of a reader that has left is given again, to start anew") {
  Fixture f;
  const auto publisher = f.publisher();
  for (uint64_t number = 1; number <= 100; ++number) {
    const auto guest = f.subscription(keep_last(1));
    publish(*publisher, number);
    CHECK(given_seats(f, *publisher) == 1);
    CHECK(seat_of(f, *publisher, *guest)->taken == number - 1);
    CHECK(take_all(*guest) == numbers(number, number));
    CHECK(guest->lost() == 0);
  }
}

TEST_CASE("more readers than a header and several blocks have seats for; all goes back") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.publisher();
  auto readers = f.subscriptions(1000, keep_last(2));
  publish(*publisher, 1);
  CHECK(given_seats(f, *publisher) == readers.size());
  readers.erase(readers.begin() + 3, readers.begin() + 900);
  publish(*publisher, 2);
  CHECK(given_seats(f, *publisher) == readers.size());
  for (const auto & each : readers) {
    CHECK(take_all(*each) == numbers(1, 2));
  }
  publisher.reset();
  readers.clear();
  f.inspection.wait_until_swept();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("creation accesses no memory of a peer, and needs none") {
  Fixture f;
  const auto publisher = f.publisher();
  publish(*publisher, 1);
  const uint64_t used = f.inspection.used_bytes();
  const auto reader = f.subscription(keep_last(1));
  const uint64_t one = f.inspection.used_bytes() - used;
  const auto others = f.subscriptions(50, keep_last(1));
  CHECK(f.inspection.used_bytes() - used == 51 * one);
  CHECK(given_seats(f, *publisher) == 0);
}

TEST_CASE("late readers of a history whose publisher stays silent and closes get it") {
  Fixture f;
  auto publisher = f.publisher(transient_local(5));
  for (uint64_t number = 1; number <= 9; ++number) {
    publish(*publisher, number);
  }
  const auto readers = f.subscriptions(200, transient_local(5));
  publisher.reset();
  for (const auto & each : readers) {
    CHECK(take_all(*each) == numbers(5, 9));
    CHECK(each->lost() == 0);
  }
  f.inspection.wait_until_swept();
}
