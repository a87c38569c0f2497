// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Many pushers and one popper concurrently. Cannot prove that an interleaving that did not occur is
// harmless: docs/model/ explores all of them for a small queue. Neither covers a pusher delayed for
// 65,536 laps of the queue. Pushers that die: test_killed.
#include <doctest/doctest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "bare_queue.hpp"

using namespace manycore;

namespace {

struct Load {
  uint32_t depth;
  bool keep_all;
  uint32_t pushers;
  uint64_t hints_each;
};

/// What the popper observed, and what a bystander counted meanwhile.
struct Outcome {
  uint64_t most_displaced = 0;
  uint64_t popped = 0;
  uint64_t foreign = 0;
  uint64_t out_of_order = 0;
};

void look_at(const Hint & hint, std::vector<uint64_t> & last, Outcome & outcome) {
  ++outcome.popped;
  if (hint.publisher >= last.size() || hint.incarnation != (hint.publisher & 63)) {
    ++outcome.foreign;
    return;
  }
  outcome.out_of_order += hint.number > last[hint.publisher] ? 0 : 1;
  last[hint.publisher] = hint.number;
}

Outcome run(BareQueue & queue, const Load & load) {
  std::atomic<uint32_t> pushing{load.pushers};
  std::vector<std::thread> threads;
  for (uint32_t source = 0; source < load.pushers; ++source) {
    threads.emplace_back([&, source] {
      for (uint64_t number = 1; number <= load.hints_each; ++number) {
        queue.push({source, source & 63, number});
      }
      --pushing;
    });
  }
  Outcome outcome;
  threads.emplace_back([&] {
    while (pushing != 0) {
      outcome.most_displaced = std::max(outcome.most_displaced, queue.displaced());
    }
  });
  std::vector<uint64_t> last(load.pushers, 0);
  bool more = true;
  while (more) {
    more = pushing != 0;  // loaded before the queue is drained
    while (const std::optional<Hint> hint = queue.pop()) {
      look_at(*hint, last, outcome);
    }
  }
  for (std::thread & thread : threads) {
    thread.join();
  }
  return outcome;
}

constexpr uint64_t many = 60'000;

}  // namespace

TEST_CASE("KEEP_LAST: every hint is popped or counted as displaced, in the order of its pusher") {
  for (const uint32_t depth : {1u, 2u, 7u, 64u, 1000u}) {
    CAPTURE(depth);
    BareQueue queue(depth, false);
    const Outcome outcome = run(queue, {depth, false, 3, many});
    CHECK(outcome.foreign == 0);
    CHECK(outcome.out_of_order == 0);
    CHECK(outcome.popped + queue.displaced() == 3 * many);
    CHECK(outcome.most_displaced <= queue.displaced());
    CHECK(queue.header().head == queue.header().tail);
    CHECK(queue.header().resync == 0);
  }
}

TEST_CASE("KEEP_ALL: nothing is displaced; resync reports what did not fit") {
  for (const uint32_t depth : {1u, 16u, 1024u}) {
    CAPTURE(depth);
    BareQueue queue(depth, true);
    const Outcome outcome = run(queue, {depth, true, 3, many});
    CHECK(outcome.foreign == 0);
    CHECK(outcome.out_of_order == 0);
    CHECK(queue.displaced() == 0);
    CHECK(outcome.most_displaced == 0);
    CHECK((outcome.popped == 3 * many || queue.header().resync == 1));
  }
}

TEST_CASE("a queue that is never popped holds the newest hints") {
  constexpr uint32_t depth = 10;
  BareQueue queue(depth, false);
  std::vector<std::thread> pushers;
  for (uint32_t source = 0; source < 4; ++source) {
    pushers.emplace_back([&queue, source] {
      for (uint64_t number = 1; number <= many; ++number) {
        queue.push({source, 0, number});
      }
    });
  }
  for (std::thread & pusher : pushers) {
    pusher.join();
  }
  CHECK(queue.displaced() == 4 * many - depth);
  uint32_t held = 0;
  std::vector<uint64_t> newest(4, 0);
  while (const std::optional<Hint> hint = queue.pop()) {
    ++held;
    newest[hint->publisher] = hint->number;
  }
  CHECK(held == depth);
  CHECK(*std::max_element(newest.begin(), newest.end()) == many);
}
