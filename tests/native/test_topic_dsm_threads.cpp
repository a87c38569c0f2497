// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Publishers and subscriptions of one process run concurrently; each message is checked byte by
// byte. Under the thread sanitizer this shows that claim and release order all accesses to a
// record's bytes. It cannot prove the absence of a harmful interleaving that did not occur, nor
// anything about processes that die: see docs/model/ and test_killed. Only one cluster; with
// receive threads: test_clusters.
#include <doctest/doctest.h>

#include <future>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"

using namespace manycore;

namespace {

struct Fixture {
  TestPlatform platform;
  Configurator configurator{platform.name(), host_profile(), {{"/fixed", 1, 4000, 0}}};
  std::shared_ptr<Process> process = platform.join();
  std::optional<Standstill> receive_thread{std::in_place, platform, 1};
};

constexpr uint64_t messages_each = 5000;

size_t size_of(uint64_t writer, uint64_t number) {
  return sizeof(Payload) + (writer * 131 + number * 37) % 600;
}

/// Publishes messages_each messages of `writer`.
void publish_all(Publisher & publisher, uint64_t writer) {
  for (uint64_t number = 1; number <= messages_each; ++number) {
    publish(publisher, number, size_of(writer, number), writer);
  }
}

/// Takes until all are published and nothing is left; returns how many. Throws on a torn message or
/// a wrong order.
uint64_t take_until(
  Process & process, Subscription & subscription, std::atomic<bool> & published_all) {
  std::map<uint64_t, uint64_t> last;
  uint64_t taken = 0;
  bool more = true;
  while (more) {
    more = !published_all;  // loaded before the subscription is drained
    while (const std::optional<Payload> payload = take(subscription)) {
      if (payload->number <= std::exchange(last[payload->writer], payload->number)) {
        throw std::runtime_error("wrong order");
      }
      ++taken;
    }
    process.waiters().common().wait(process.waiters().common().epoch(), monotonic_ns() + 1'000'000);
  }
  return taken;
}

}  // namespace

TEST_CASE(
  "many publishers, many subscriptions: nothing torn, in order, and all that is missing is "
  "counted") {
  for (const std::string topic : {"/fixed", "/growing"}) {
    CAPTURE(topic);
    Fixture f;
    constexpr uint64_t publishers = 3;
    std::atomic<bool> published_all{false};
    std::vector<std::unique_ptr<Subscription>> subscriptions;
    std::vector<std::future<uint64_t>> taken;
    for (const uint32_t depth : {1u, 10u, 100u}) {
      subscriptions.push_back(f.process->create_subscription(on_topic(topic, keep_last(depth))));
      taken.push_back(std::async(std::launch::async, [&, s = subscriptions.back().get()] {
        return take_until(*f.process, *s, published_all);
      }));
    }
    std::vector<std::unique_ptr<Publisher>> kept;
    std::vector<std::future<void>> sent;
    for (uint64_t writer = 1; writer <= publishers; ++writer) {
      kept.push_back(f.process->create_publisher(on_topic(topic, keep_last(10))));
      sent.push_back(std::async(
        std::launch::async, [p = kept.back().get(), writer] { publish_all(*p, writer); }));
    }
    for (std::future<void> & done : sent) {
      done.get();
    }
    published_all = true;
    for (size_t i = 0; i < subscriptions.size(); ++i) {
      CAPTURE(i);
      const uint64_t count = taken[i].get();
      CHECK(count > 0);
      const uint64_t missed = subscriptions[i]->lost() + subscriptions[i]->superseded();
      CHECK(count + missed == publishers * messages_each);
    }
  }
}

TEST_CASE(
  "one publisher shared by threads: each publishes whole messages, sequence numbers are unique") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/shared", keep_last(10)));
  const auto subscription =
    f.process->create_subscription(on_topic("/shared", keep_last(4 * messages_each)));
  std::vector<std::future<void>> sent;
  for (uint64_t writer = 1; writer <= 4; ++writer) {
    sent.push_back(
      std::async(std::launch::async, [&, writer] { publish_all(*publisher, writer); }));
  }
  std::map<uint64_t, uint64_t> last;
  for (uint64_t sequence = 1; sequence <= 4 * messages_each; ++sequence) {
    const Payload payload = take_next(*f.process, *subscription);
    REQUIRE(payload.number == last[payload.writer] + 1);
    last[payload.writer] = payload.number;
  }
  CHECK(subscription->lost() == 0);
}

TEST_CASE("one subscription shared by threads: each message is taken once") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/shared", keep_last(10)));
  const auto subscription =
    f.process->create_subscription(on_topic("/shared", keep_last(messages_each)));
  std::atomic<bool> published_all{false};
  std::vector<std::future<uint64_t>> taken;
  for (int i = 0; i < 3; ++i) {
    taken.push_back(std::async(
      std::launch::async, [&] { return take_until(*f.process, *subscription, published_all); }));
  }
  publish_all(*publisher, 1);
  published_all = true;
  CHECK(taken[0].get() + taken[1].get() + taken[2].get() == messages_each);
}

TEST_CASE("a claim that one thread made is ended by another") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/growing", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/growing", keep_last(10)));
  constexpr uint64_t messages = 10;
  for (uint64_t number = 1; number <= messages; ++number) {
    publish(*publisher, number);
  }
  for (uint64_t number = 1; number <= messages; ++number) {
    std::optional<Claim> claim = subscription->claim();
    REQUIRE(claim);
    CHECK(claim->info().publication_sequence_number == number);
    std::thread([ended = std::move(*claim)] {}).join();
  }
  CHECK_FALSE(subscription->claim());
}

TEST_CASE("subscriptions and publishers are created and closed under load") {
  for (const std::string topic : {"/fixed", "/growing"}) {
    CAPTURE(topic);
    Fixture f;
    std::atomic<bool> ends{false};
    auto steady = std::async(std::launch::async, [&] {
      const auto publisher = f.process->create_publisher(on_topic(topic, transient_local(5)));
      uint64_t number = 0;
      while (!ends) {
        ++number;
        publish(*publisher, number, size_of(1, number), 1);
      }
    });
    auto readers = std::async(std::launch::async, [&] {
      for (int i = 0; i < 150; ++i) {
        const auto late = f.process->create_subscription(on_topic(topic, transient_local(5)));
        uint64_t last = 0;
        for (int k = 0; k < 20; ++k) {
          const Payload payload = take_next(*f.process, *late);
          if (payload.writer == 1 && payload.number <= std::exchange(last, payload.number)) {
            throw std::runtime_error("wrong order");
          }
        }
      }
    });
    auto writers = std::async(std::launch::async, [&] {
      for (uint64_t writer = 2; writer < 150; ++writer) {
        const auto guest = f.process->create_publisher(on_topic(topic, transient_local(3)));
        for (uint64_t number = 1; number <= 10; ++number) {
          publish(*guest, number, size_of(writer, number), writer);
        }
      }
    });
    CHECK_NOTHROW(readers.get());
    CHECK_NOTHROW(writers.get());
    ends = true;
    CHECK_NOTHROW(steady.get());
    Inspection inspection(f.platform);
    f.receive_thread.reset();
    inspection.wait_until_swept();
    CHECK(inspection.live_endpoints() == 0);
  }
}
