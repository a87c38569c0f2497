// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Holds: records whose bytes stay after their claims. Their orders of stores: docs/model/holds.pml.
#include <doctest/doctest.h>

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "drivers_of_test.hpp"
#include "stepped_child.hpp"
#include "transport/topic_dsm/chunk_table.hpp"
#include "waiting.hpp"

using namespace drivers_of_test;

namespace {

constexpr size_t large = 100'000;

std::unique_ptr<Hold> hold_of(Claim & claim) {
  std::optional<Hold> hold = claim.hold();
  return hold ? std::make_unique<Hold>(std::move(*hold)) : nullptr;
}

std::unique_ptr<Hold> hold_next(Subscription & subscription) {
  auto claim = subscription.claim();
  REQUIRE(claim);
  return hold_of(*claim);
}

uint64_t number_in(const Hold & hold) { return Payload::read(hold.data(), hold.size()).number; }

uint32_t chunks_of(Fixture & f, const Publisher & publisher) {
  uint32_t count = 0;
  manycore::chunks_of(f.inspection.registry().clusters().at(1), f.inspection.header_of(publisher))
    .visit([&](const ChunkEntry & entry) {
      count += entry.offset.load() != 0 ? 1 : 0;
      return false;
    });
  return count;
}

/// Holds the next message, then takes the rest while single-stepped.
const Role holds("holds", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto subscription = process->create_subscription(on_topic("/driver", transient_local(4)));
  begin_steps();
  std::vector<std::unique_ptr<Hold>> kept;
  while (auto claim = subscription->claim()) {
    if (auto hold = hold_of(*claim)) {
      kept.push_back(std::move(hold));
    }
  }
  kept.clear();
  finish_steps();
});

}  // namespace

TEST_CASE("a held message stays while its publisher goes on, in bounded memory") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(2));
  const auto subscription = f.subscription(keep_last(2));
  publish(*publisher, 1, large);
  const auto first = hold_next(*subscription);
  REQUIRE(first);
  for (uint64_t number = 2; number <= 100; ++number) {
    publish(*publisher, number, large);
    const auto each = hold_next(*subscription);
    REQUIRE(each);
    CHECK(number_in(*each) == number);
    CHECK(number_in(*first) == 1);
  }
  CHECK(chunks_of(f, *publisher) <= 5);
  CHECK(subscription->lost() == 0);
}

TEST_CASE("what follows the encapsulation of a held message is aligned to 64 bytes") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto subscription = f.subscription(keep_last(1));
  publish(*publisher, 1, large);
  const auto hold = hold_next(*subscription);
  CHECK((reinterpret_cast<uintptr_t>(hold->data()) + 4) % 64 == 0);
}

TEST_CASE("small messages are not held") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto subscription = f.subscription(keep_last(1));
  publish(*publisher, 1, min_chunk_message_bytes - 1);
  CHECK_FALSE(hold_next(*subscription));
  publish(*publisher, 2, min_chunk_message_bytes);
  CHECK(hold_next(*subscription));
}

TEST_CASE("only the one reader that a message is for is alone with it") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(4));
  const auto first = f.subscription(keep_last(4));
  publish(*publisher, 1, large);
  auto second = f.subscription(keep_last(4));
  CHECK(hold_next(*first)->is_sole());
  publish(*publisher, 2, large);
  const auto of_first = hold_next(*first);
  const auto of_second = hold_next(*second);
  CHECK_FALSE(of_first->is_sole());
  CHECK_FALSE(of_second->is_sole());
  CHECK(of_first->data() == of_second->data());
  second.reset();
  publish(*publisher, 3, large);
  CHECK(hold_next(*first)->is_sole());
}

TEST_CASE("no reader is alone with a message of a history, which others may still ask for") {
  Fixture f;
  const auto publisher = f.publisher(transient_local(4));
  const auto subscription = f.subscription(transient_local(4));
  publish(*publisher, 1, large);
  CHECK_FALSE(hold_next(*subscription)->is_sole());
}

TEST_CASE("a hold outlives subscription and publisher; then the memory is free") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  auto publisher = f.publisher();
  auto subscription = f.subscription(keep_last(4));
  std::vector<std::unique_ptr<Hold>> kept;
  for (uint64_t number = 1; number <= 3; ++number) {
    publish(*publisher, number, large);
    kept.push_back(hold_next(*subscription));
  }
  subscription.reset();
  publisher.reset();
  f.drive(10, large);
  CHECK(number_in(*kept[0]) == 1);
  CHECK(number_in(*kept[2]) == 3);
  kept.erase(kept.begin());
  CHECK(number_in(*kept[1]) == 3);
  kept.clear();
  f.inspection.wait_until_swept();
  CHECK(f.inspection.used_bytes() == used);
}

TEST_CASE("a chunk has room for fifteen holders; further readers copy") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto readers = f.subscriptions(max_holders + 2, keep_last(1));
  publish(*publisher, 1, large);
  std::vector<std::unique_ptr<Hold>> kept;
  for (const auto & reader : readers) {
    auto claim = reader->claim();
    if (auto hold = hold_of(*claim)) {
      kept.push_back(std::move(hold));
    } else {
      CHECK(claim->reached_limit().find(": 15 readers keep the same message") != std::string::npos);
    }
  }
  CHECK(kept.size() == max_holders);
}

TEST_CASE("a subscription holds its depth and four more messages at most") {
  Fixture f;
  const auto publisher = f.publisher();
  const auto subscription = f.subscription(keep_last(3));
  std::vector<std::unique_ptr<Hold>> kept;
  for (uint64_t number = 1; number <= 20; ++number) {
    publish(*publisher, number, large);
    if (auto hold = hold_next(*subscription)) {
      kept.push_back(std::move(hold));
    }
  }
  CHECK(kept.size() == 7);
  CHECK(number_in(*kept[0]) == 1);
  kept.clear();
  publish(*publisher, 21, large);
  CHECK(hold_next(*subscription));
}

TEST_CASE("nothing is held while more than half of the SMEM is in use") {
  Fixture f;
  const auto filler = f.process->create_publisher(on_topic("/filler", transient_local(9)));
  for (uint64_t number = 1; number <= 9; ++number) {
    publish(*filler, number, mebibyte);
  }
  const auto publisher = f.publisher();
  const auto subscription = f.subscription(keep_last(1));
  publish(*publisher, 1, large);
  CHECK(hold_next(*subscription));
  const auto more = f.process->create_publisher(on_topic("/more", transient_local(9)));
  for (uint64_t number = 1; number <= 9; ++number) {
    publish(*more, number, mebibyte);
  }
  publish(*publisher, 2, large);
  CHECK_FALSE(hold_next(*subscription));
}

TEST_CASE("messages of any sizes, held and given back at random, stay as they were published") {
  Fixture f;
  std::mt19937 random(7);
  const auto publisher = f.publisher(keep_last(3));
  std::vector<std::unique_ptr<Subscription>> readers = f.subscriptions(2, keep_last(3));
  std::vector<std::pair<std::unique_ptr<Hold>, uint64_t>> kept;
  uint64_t in_place = 0;
  for (uint64_t number = 1; number <= 1000; ++number) {
    if (random() % 20 == 0) {
      readers[random() % 2] = f.subscription(keep_last(3));
    }
    const size_t most = random() % 4 == 0 ? 300'000 : 100'000;
    publish(*publisher, number, 20'000 + random() % most);
    for (const auto & reader : readers) {
      while (random() % 3 != 0) {
        auto claim = reader->claim();
        if (!claim) {
          break;
        }
        const uint64_t taken = Payload::read(claim->data(), claim->size()).number;
        if (auto hold = hold_of(*claim)) {
          kept.emplace_back(std::move(hold), taken);
          ++in_place;
        }
      }
    }
    while (kept.size() > 8 || (!kept.empty() && random() % 3 == 0)) {
      std::swap(kept[random() % kept.size()], kept.back());
      CHECK(number_in(*kept.back().first) == kept.back().second);
      kept.pop_back();
    }
  }
  CHECK(in_place > 200);
}

TEST_CASE("where SMEM is full of untaken messages, the oldest make room") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(1));
  const auto subscription = f.subscription(keep_last(1000));
  for (uint64_t number = 1; number <= 20; ++number) {
    publish(*publisher, number, (number % 4 + 1) * mebibyte);
  }
  const std::vector<uint64_t> taken = take_all(*subscription);
  REQUIRE(taken.size() > 2);
  CHECK(taken == numbers(20 - taken.size() + 1, 20));
  CHECK(subscription->lost() == 20 - taken.size());
}

TEST_CASE("a program that keeps all messages leaves the publisher room for another one") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(1));
  const auto subscription = f.subscription(keep_last(1000));
  std::vector<std::unique_ptr<Hold>> kept;
  for (uint64_t number = 1; number <= 20; ++number) {
    publish(*publisher, number, 5 * mebibyte);
    if (auto hold = hold_next(*subscription)) {
      kept.push_back(std::move(hold));
    }
  }
  CHECK(kept.size() == 2);
  CHECK(number_in(*kept[0]) == 1);
  CHECK(subscription->lost() == 0);
}

TEST_CASE("where holders leave no room for a larger message, the error names them") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(1));
  const auto subscription = f.subscription(keep_last(1000));
  std::vector<std::unique_ptr<Hold>> kept;
  for (uint64_t number = 1; number <= 2; ++number) {
    publish(*publisher, number, 5 * mebibyte);
    kept.push_back(hold_next(*subscription));
    REQUIRE(kept.back());
  }
  const Refusal refusal = refusal_of([&] { publish(*publisher, 3, 8 * mebibyte); });
  CHECK(refusal.code == ErrorCode::too_large);
  CHECK_MESSAGE(refusal.says("subscriptions read or hold 10"), refusal.text);
  kept.pop_back();
  CHECK_FALSE(refusal_of([&] { publish(*publisher, 4, 8 * mebibyte); }).code);
  CHECK(number_in(*kept[0]) == 1);
}

TEST_CASE("chunks that fall out of use are freed") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(2));
  const auto subscription = f.subscription(keep_last(8));
  for (uint64_t number = 1; number <= 8; ++number) {
    publish(*publisher, number, large);
  }
  CHECK(chunks_of(f, *publisher) == 8);
  take_all(*subscription);
  for (uint64_t number = 9; number <= 600; ++number) {
    publish(*publisher, number, number % 8 == 0 ? large : sizeof(Payload));
    take_all(*subscription);
  }
  CHECK(chunks_of(f, *publisher) <= 2);
}

TEST_CASE("loans are filled while their publisher goes on; what is not published is used again") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(3));
  const auto subscription = f.subscription(keep_last(3));
  for (uint64_t number = 1; number <= 60; number += 3) {
    std::optional<Loan> loan = publisher->lend(large);
    std::optional<Loan> small = publisher->lend(sizeof(Payload));
    const std::optional<Loan> unused = publisher->lend(large);
    REQUIRE((loan && small && unused));
    publish(*publisher, number, large);
    Payload{1, number + 1, large}.write(loan->data());
    Payload{1, number + 2, sizeof(Payload)}.write(small->data());
    publisher->publish(std::move(*loan), large, 1);
    publisher->publish(std::move(*small), sizeof(Payload), 1);
    CHECK(take_all(*subscription) == numbers(number, number + 2));
  }
  CHECK(chunks_of(f, *publisher) <= 5);
}

TEST_CASE("what loans alone leave behind is freed as well") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(200));
  const auto subscription = f.subscription(keep_last(200));
  for (uint64_t number = 1; number <= 1000; ++number) {
    std::optional<Loan> loan = publisher->lend(sizeof(Payload));
    REQUIRE(loan);
    Payload{1, number, sizeof(Payload)}.write(loan->data());
    publisher->publish(std::move(*loan), sizeof(Payload), 1);
    if (number >= 200) {
      take_all(*subscription);
    }
    if (number == 200) {
      CHECK(chunks_of(f, *publisher) == 200);
    }
  }
  CHECK(f.inspection.generations_of(*publisher) == 1);
  CHECK(chunks_of(f, *publisher) < 200);
}

TEST_CASE("a repair of the registry finds chunks and their table") {
  Fixture f;
  const auto publisher = f.publisher(keep_last(100));
  const auto subscription = f.subscription(keep_last(100));
  for (uint64_t number = 1; number <= 100; ++number) {  // more than a block of the table has
    publish(*publisher, number, min_chunk_message_bytes);
  }
  const uint64_t used = f.inspection.used_bytes();
  f.inspection.registry().header().needs_repair = 1;
  f.process->add_node("node", "/", "/");
  CHECK(f.inspection.used_bytes() == used);
  CHECK(take_all(*subscription) == numbers(1, 100));
}

TEST_CASE("a topic DSM of a fixed size has no chunks: it lends nothing, and nothing is held") {
  const TestPlatform platform;
  const Configurator configurator(
    platform.name(), profile_of(32 * mebibyte), {{"/driver", 1, 2 * mebibyte, 0}});
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/driver", keep_last(1)));
  const auto subscription = process->create_subscription(on_topic("/driver", keep_last(1)));
  CHECK_FALSE(publisher->lend(large));
  publish(*publisher, 1, large);
  CHECK_FALSE(hold_next(*subscription));
}

TEST_CASE("of a process that is killed while it takes holds, all memory is free again") {
  Fixture f;
  const uint64_t used = f.inspection.used_bytes();
  for (uint64_t steps = 200; steps < 20'000; steps += steps / 2) {
    auto publisher = f.publisher(transient_local(4));
    for (uint64_t number = 1; number <= 4; ++number) {
      publish(*publisher, number, large);
    }
    SteppedChild child("holds", {f.platform.name()});
    child.step(steps);
    child.kill();
    for (uint64_t number = 5; number <= 8; ++number) {
      publish(*publisher, number, large);
    }
    publisher.reset();
    wait_until("the child is reaped", [&] { return f.inspection.live_processes() == 1; });
    f.inspection.wait_until_swept();
    CHECK(f.inspection.used_bytes() == used);
  }
}
