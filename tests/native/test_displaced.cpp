// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Losses are asked for while a take stands between counting its pop and moving `head`, where the
// number of displaced hints is not exact.
#include <doctest/doctest.h>

#include <atomic>
#include <thread>

#include "bare_queue.hpp"
#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/registry/endpoint_blocks.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

void stand_in_a_pop(SubscriptionHeader & header) { header.pops_begun = header.pops_done + 1; }

void leave_the_pop(SubscriptionHeader & header) { header.pops_begun = header.pops_done.load(); }

}  // namespace

TEST_CASE("a displaced double is no loss") {
  BareQueue queue(1, false);
  queue.push({0, 0, 1});
  queue.push({0, 0, 1});
  SubscriptionHeader & header = queue.header();
  static EndpointEntry entry;
  entry.qos = keep_last(2);
  const auto lost = [&] { return missed_so_far(entry, header, queue.displaced()).lost; };
  CHECK(lost() == 1);  // as far as is known yet
  header.missed_beside_displaced = entry.counters.lost - queue.displaced();
  CHECK(lost() == 0);
  stand_in_a_pop(header);
  CHECK(lost() == 0);
  leave_the_pop(header);
  queue.push({0, 0, 2});
  CHECK(lost() == 1);
}

TEST_CASE("a thread that asks for losses during a take is told of each displaced hint") {
  const TestPlatform platform;
  const auto process = platform.join(1);
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(2)));
  const auto subscription = process->create_subscription(on_topic("/x", keep_last(2)));
  Inspection inspection(platform);
  SubscriptionHeader & header = inspection.header_of(*subscription);
  for (uint64_t number = 1; number <= 3; ++number) {
    publish(*publisher, number);
  }
  stand_in_a_pop(header);
  std::atomic<pid_t> asking{0};
  std::atomic<bool> is_told{false};
  uint64_t lost = 0;
  std::thread thread([&] {
    asking = gettid();
    lost = subscription->lost();
    is_told = true;
  });
  wait_until("it waits", [&] { return is_told || (asking != 0 && is_asleep(asking)); });
  leave_the_pop(header);
  thread.join();
  CHECK(lost == 1);
}
