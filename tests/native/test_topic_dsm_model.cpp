// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Random operations of publishers and subscriptions against the simplest model of KEEP_LAST: each
// subscription holds the last `depth` messages that it has not taken. Single-threaded, so each
// difference is a bug, and reproducible by its seed.
#include <doctest/doctest.h>

#include <deque>
#include <random>

#include "messages.hpp"
#include "platform_of_test.hpp"

using namespace manycore;

namespace {

struct Reader {
  uint32_t depth;
  std::unique_ptr<Subscription> subscription;
  std::deque<uint64_t> expected;
  uint64_t published = 0;
  uint64_t taken = 0;
};

class Game {
public:
  Game(std::shared_ptr<Process> process, uint32_t seed)
  : process_(std::move(process)), random_(seed) {}

  void step() {
    switch (below(20)) {
      case 0:
        add_reader();
        break;
      case 1:
        remove_reader();
        break;
      case 2:
        publisher_.reset();  // its readers may still take what it left
        break;
      case 3:
        hold_a_claim_while_publishing();
        break;
      default:
        below(2) == 0 ? publish_some() : take_some();
    }
  }

private:
  uint32_t below(uint32_t limit) {
    return std::uniform_int_distribution<uint32_t>(0, limit - 1)(random_);
  }

  void add_reader() {
    if (readers_.size() < 5) {
      const uint32_t depth = 1 + below(below(2) == 0 ? 4 : 60);
      readers_.push_back(
        {depth, process_->create_subscription(on_topic("/model", keep_last(depth))), {}});
    }
  }

  void remove_reader() {
    if (!readers_.empty()) {
      readers_.erase(readers_.begin() + below(static_cast<uint32_t>(readers_.size())));
    }
  }

  void publish_one() {
    if (!publisher_) {
      publisher_ = process_->create_publisher(on_topic("/model", keep_last(1 + below(20))));
    }
    const size_t size = sizeof(Payload) + below(1u << below(14));
    publish(*publisher_, ++number_, size);
    for (Reader & reader : readers_) {
      ++reader.published;
      reader.expected.push_back(number_);
      if (reader.expected.size() > reader.depth) {
        reader.expected.pop_front();
      }
    }
  }

  void publish_some() {
    for (uint32_t count = below(12); count != 0; --count) {
      publish_one();
    }
  }

  void check(Reader & reader, const std::optional<Payload> & payload) {
    REQUIRE(payload.has_value() == !reader.expected.empty());
    if (payload) {
      REQUIRE(payload->number == reader.expected.front());
      reader.expected.pop_front();
      ++reader.taken;
    }
    if (!payload) {  // nothing is left to take, so everything is accounted for
      const Subscription & subscription = *reader.subscription;
      REQUIRE(reader.taken + subscription.lost() + subscription.superseded() == reader.published);
    }
  }

  void take_some() {
    for (Reader & reader : readers_) {
      for (uint32_t count = below(12); count != 0; --count) {
        check(reader, take(*reader.subscription));
      }
    }
  }

  void hold_a_claim_while_publishing() {
    if (readers_.empty()) {
      return;
    }
    Reader & reader = readers_[below(static_cast<uint32_t>(readers_.size()))];
    const std::optional<Claim> claim = reader.subscription->claim();
    if (!claim) {
      return;
    }
    check(reader, Payload::read(claim->data(), claim->size()));
    publish_some();
    REQUIRE_NOTHROW(Payload::read(claim->data(), claim->size()));
  }

  std::shared_ptr<Process> process_;
  std::mt19937 random_;
  std::unique_ptr<Publisher> publisher_;
  std::vector<Reader> readers_;
  uint64_t number_ = 0;
};

}  // namespace

TEST_CASE("random operations satisfy KEEP_LAST") {
  TestPlatform platform;
  const std::shared_ptr<Process> process = platform.join();
  const Standstill receive_thread(platform, 1);
  for (uint32_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Game game(process, seed);
    for (int step = 0; step < 300; ++step) {
      CAPTURE(step);
      game.step();
    }
  }
}
