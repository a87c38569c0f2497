// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Memory to which a burst or a stuck reader made a topic DSM grow is returned to the cluster and to
// the system once a smaller ring has sufficed for long, and no reference leads into it any more.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/queue/reading.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint64_t mebibyte = 1 << 20;

struct Fixture {
  /// Publishes `count` messages; the subscription takes each at once.
  void stream(Publisher & publisher, Subscription & subscription, uint64_t count) {
    for (uint64_t i = 0; i < count; ++i) {
      publish(publisher, ++published, 100);
      REQUIRE(take(subscription)->number == published);
    }
  }
  /// Publishes `count` messages, which are taken only when all are published.
  void burst(
    Publisher & publisher, Subscription & subscription, uint64_t count, size_t size_bytes) {
    for (uint64_t i = 0; i < count; ++i) {
      publish(publisher, ++published, size_bytes);
    }
    CHECK(take_all(subscription) == numbers(published - count + 1, published));
  }
  TopicDsmHeader & dsm_of(const Publisher & publisher) {
    Registry & registry = inspection.registry();
    return *registry.clusters().find<TopicDsmHeader>(
      registry.endpoints()[inspection.slot_of(publisher.gid())].block);
  }
  /// First record number of the current generation, which identifies it.
  uint64_t newest_generation(const Publisher & publisher) {
    uint64_t newest = 0;
    for (const GenerationEntry & generation : dsm_of(publisher).generations) {
      newest = std::max(newest, generation.first.load());
    }
    return newest;
  }
  uint64_t resident_bytes() const { return inspection.resident_bytes(); }
  uint64_t used_bytes() { return inspection.used_bytes(); }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  uint64_t published = 0;
};

}  // namespace

TEST_CASE("memory added for a burst is returned to cluster and system") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/burst", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/burst", keep_last(1000)));
  f.stream(*publisher, *subscription, 10);
  const uint64_t used = f.used_bytes();
  const uint64_t resident = f.resident_bytes();
  SUBCASE("many messages") { f.burst(*publisher, *subscription, 1000, 50'000); }
  SUBCASE("one large message") { f.burst(*publisher, *subscription, 1, 64 * mebibyte); }
  CHECK(f.used_bytes() > used + 40 * mebibyte);
  f.stream(*publisher, *subscription, 5000);
  CHECK(f.used_bytes() < used + mebibyte / 4);
  CHECK(f.resident_bytes() < resident + mebibyte / 4);
}

TEST_CASE("memory added for a stuck reader is returned once the reader continues") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/stuck", keep_last(10)));
  const auto quick = f.process->create_subscription(on_topic("/stuck", keep_last(10)));
  const auto stuck = f.process->create_subscription(on_topic("/stuck", keep_last(500)));
  const uint64_t used = f.used_bytes();
  f.burst(*publisher, *quick, 10, 20'000);
  f.burst(*publisher, *quick, 10, 20'000);
  f.stream(*publisher, *quick, 5000);
  CHECK(f.used_bytes() > used + 500 * 100);
  CHECK(take_all(*stuck) == numbers(f.published - 499, f.published));
  for (int i = 0; i < 5000; ++i) {
    f.stream(*publisher, *quick, 1);
    REQUIRE(take(*stuck)->number == f.published);
  }
  CHECK(f.used_bytes() < used + 16'000);
}

TEST_CASE("a history kept for late joiners survives shrinking") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/history", transient_local(20)));
  const auto subscription = f.process->create_subscription(on_topic("/history", keep_last(300)));
  const uint64_t used = f.used_bytes();
  f.burst(*publisher, *subscription, 300, 50'000);
  for (int i = 0; i < 3000; ++i) {
    f.stream(*publisher, *subscription, 1);
    if (i % 100 == 0) {
      const auto late = f.process->create_subscription(on_topic("/history", transient_local(20)));
      CHECK(take_all(*late) == numbers(f.published - 19, f.published));
    }
  }
  CHECK(f.used_bytes() < used + mebibyte / 4);
}

TEST_CASE("recurring bursts resize a topic DSM a few times, then no more") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/bursts", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/bursts", keep_last(100)));
  uint64_t newest = 0;
  uint64_t changes_at_first = 0;
  uint64_t changes_later = 0;
  for (int round = 0; round < 60; ++round) {
    f.burst(*publisher, *subscription, 100, 1000);
    for (int i = 0; i < 15; ++i) {
      f.stream(*publisher, *subscription, 100);
      const uint64_t now = f.newest_generation(*publisher);
      (round < 30 ? changes_at_first : changes_later) += now != newest ? 1 : 0;
      newest = now;
    }
  }
  CHECK(changes_at_first < 12);
  CHECK(changes_later == 0);
}

TEST_CASE("a generation that a reader may access is closed, but not freed") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/claimed", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/claimed", keep_last(10)));
  publish(*publisher, 1);
  CHECK(take_all(*subscription) == numbers(1, 1));
  GenerationEntry & old = f.dsm_of(*publisher).generations[0];
  std::atomic<uint64_t> & reading = f.inspection.header_of(*subscription).reading;
  const uint32_t slot = f.inspection.slot_of(publisher->gid());
  const uint32_t incarnation = f.inspection.registry().endpoints()[slot].slot.incarnation;
  // As of a reader that was stopped before it looked up its record.
  reading.store(Reading::of({slot, incarnation, 1}));
  publish(*publisher, 2, 60'000);  // grows
  for (uint64_t number = 3; number <= 10 && old.first.load() != 0; ++number) {
    publish(*publisher, number);
  }
  CHECK(old.first.load() == 0);
  CHECK(old.offset.load() != 0);
  reading.store(Reading::nothing);
  wait_until("the registry lock is to be had", [&] {
    publish(*publisher, 11);
    return old.offset.load() == 0;
  });
}

TEST_CASE("a late eMCOS message does not access a freed topic DSM") {
  Fixture f;
  auto publisher = f.process->create_publisher(on_topic("/gone", keep_last(10)));
  Cluster & cluster = f.inspection.registry().clusters().at(1);
  const uint32_t slot = f.inspection.slot_of(publisher->gid());
  const EndpointEntry & entry = f.inspection.registry().endpoints()[slot];
  EmcosMessage message{};
  message.kind = EmcosMessageKind::publish;
  message.topic_dsm = entry.block;
  message.endpoint = slot;
  message.incarnation = entry.slot.incarnation;
  message.number = 1;
  message.target = nothing;
  f.platform.receive_thread(1);
  publisher.reset();
  wait_until("the topic DSM is free", [&] { return f.inspection.live_endpoints() == 0; });
  const uint64_t resident = f.resident_bytes();
  const uint64_t handled = cluster.header().messages.load();
  REQUIRE(cluster.send(message));
  wait_until("it is handled", [&] { return cluster.header().messages.load() > handled; });
  CHECK(f.resident_bytes() == resident);
}
