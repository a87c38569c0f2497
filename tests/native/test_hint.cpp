// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The words that name a record by few bits: hints in queues, and what a subscription is reading.
#include <doctest/doctest.h>

#include "transport/layout/registry_layout.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/queue/reading.hpp"
#include "transport/queue/subscriber_queue.hpp"

using namespace manycore;

namespace {

constexpr uint64_t period = Hint::number_mask + 1;

}  // namespace

TEST_CASE("a hint's fields keep apart, at their limits and beyond") {
  CHECK(endpoint_capacity == Hint::publisher_mask + 1);
  for (const uint32_t publisher : {0u, 1u, Hint::publisher_mask}) {
    for (const uint32_t incarnation : {1u, Hint::incarnation_mask, Hint::incarnation_mask + 1}) {
      for (const uint64_t number : {uint64_t{1}, period - 1, period, 5 * period + 3}) {
        const Hint hint = Hint::of(Hint{publisher, incarnation, number}.word());
        CHECK(hint.publisher == publisher);
        CHECK(hint.is_of(publisher, incarnation));
        CHECK_FALSE(hint.is_of(publisher, incarnation + 1));
        CHECK(hint.number == number % period);
      }
    }
  }
}

TEST_CASE("the lap of a queue's slot and the hint share no bit") {
  const Hint hint{Hint::publisher_mask, Hint::incarnation_mask, Hint::number_mask};
  const uint64_t word = subscriber_queue::encode(0xffff, hint);
  CHECK(word == UINT64_MAX);
  CHECK((subscriber_queue::encode(7, hint) >> Hint::bits) == 7);
  CHECK(subscriber_queue::decode(word).word() == hint.word());
}

TEST_CASE("the full number is the newest one with these bits, on both sides of each wrap") {
  for (const uint64_t wrap : {period, 2 * period, 1000 * period}) {
    for (uint64_t latest = wrap - 3; latest <= wrap + 3; ++latest) {
      for (uint64_t back = 0; back < 6; ++back) {
        CHECK(Hint::full_number((latest - back) % period, latest) == latest - back);
      }
      CHECK(Hint::full_number((latest + 1) % period, latest) == latest + 1 - period);
    }
  }
  CHECK(Hint::full_number(9, 5) > 5);  // none was published
}

TEST_CASE("a period is longer than two queues") {
  CHECK(period >= 2 * (uint64_t{1} << 20));  // the largest depth
}

TEST_CASE("a publisher knows its records, and no other's, by the word of a reader") {
  const Reading own(7, 4097);
  const uint64_t word = Reading::of({7, 4097, 10 * period + 5});
  CHECK(own.is(word, 10 * period + 5));
  CHECK(own.is(word, 5));  // waits in vain
  CHECK_FALSE(own.is(word, 10 * period + 6));
  CHECK_FALSE(own.is(Reading::of({8, 4097, 5}), 5));
  CHECK_FALSE(own.is(Reading::of({7, 4098, 5}), 5));
  CHECK_FALSE(own.is(Reading::nothing, 0));
  CHECK_FALSE(own.is_any(Reading::nothing));
  CHECK(own.is_any(word));
  CHECK(own.is_any(word));
  CHECK_FALSE(Reading(0, 4096).is_any(Reading::nothing));
}

TEST_CASE("a look at the header keeps no generation, one at a generation no record") {
  const Reading own(3, 1);
  const uint64_t header = Reading::header_only(3, 1);
  CHECK(own.is_any(header));
  CHECK_FALSE(own.is_any_of(header, 0, 1));
  CHECK_FALSE(own.is(header, 0));
  const uint64_t generation = Reading::generation({3, 1, period + 100});
  CHECK(own.is_any(generation));
  CHECK(own.is_any_of(generation, period + 100, period + 200));
  CHECK_FALSE(own.is_any_of(generation, period + 101, period + 200));
  CHECK_FALSE(own.is(generation, period + 100));
  CHECK_FALSE(Reading(4, 1).is_any(generation));
}

TEST_CASE("the range of a generation includes its first and last record, across a wrap") {
  const Reading own(3, 1);
  const auto is_any = [&](uint64_t number, uint64_t first, uint64_t last) {
    return own.is_any_of(Reading::of({3, 1, number}), first, last);
  };
  for (const uint64_t wrap : {uint64_t{10}, period, 7 * period}) {
    CHECK(is_any(wrap - 4, wrap - 4, wrap + 4));
    CHECK(is_any(wrap, wrap - 4, wrap + 4));
    CHECK(is_any(wrap + 4, wrap - 4, wrap + 4));
    CHECK_FALSE(is_any(wrap - 5, wrap - 4, wrap + 4));
    CHECK_FALSE(is_any(wrap + 5, wrap - 4, wrap + 4));
  }
  CHECK(is_any(1, 5 * period, 7 * period));
}
