// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// One publisher and its readers in one process, step by step: how the writer and the readers of a
// topic DSM use the memory. Concurrently: test_topic_dsm_threads.
#include <doctest/doctest.h>

#include <numeric>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"

using namespace manycore;

namespace {

constexpr size_t mebibyte = 1 << 20;

/// A platform with one node, and a topic whose topic DSM has `fixed_bytes`.
struct Fixture {
  explicit Fixture(uint32_t fixed_bytes = 4096)
  : configurator(platform.name(), host_profile(), {{"/fixed", 1, fixed_bytes, 0}}),
    process(platform.join()),
    inspection(platform),
    receive_thread(platform, 1) {}

  std::unique_ptr<Publisher> publisher(const std::string & topic, const Qos & qos) {
    return process->create_publisher(on_topic(topic, qos));
  }
  std::unique_ptr<Subscription> subscription(const std::string & topic, const Qos & qos) {
    return process->create_subscription(on_topic(topic, qos));
  }
  EndpointCounters & counters(const Publisher & publisher) {
    return inspection.registry().endpoints()[inspection.slot_of(publisher.gid())].counters;
  }

  TestPlatform platform;
  Configurator configurator;
  std::shared_ptr<Process> process;
  Inspection inspection;
  Standstill receive_thread;
};

void publish_bytes(Publisher & publisher, const std::vector<uint8_t> & bytes) {
  Draft draft = publisher.draft(bytes.size());
  std::copy(bytes.begin(), bytes.end(), draft.data());
  publisher.publish(std::move(draft), bytes.size(), realtime_ns());
}

std::vector<uint8_t> bytes_of(size_t size, uint8_t first) {
  std::vector<uint8_t> bytes(size);
  std::iota(bytes.begin(), bytes.end(), first);
  return bytes;
}

}  // namespace

TEST_CASE("messages of 0 bytes to several MiB arrive as they were, with their metadata") {
  Fixture f;
  const auto publisher = f.publisher("/sizes", keep_last(10));
  const auto subscription = f.subscription("/sizes", keep_last(10));
  uint64_t number = 0;
  for (const size_t size :
       {size_t{0}, size_t{1}, size_t{63}, size_t{64}, size_t{65}, size_t{2047}, size_t{2049},
        3 * mebibyte, size_t{5}, 8 * mebibyte + 1}) {
    CAPTURE(size);
    const std::vector<uint8_t> sent = bytes_of(size, static_cast<uint8_t>(++number));
    const int64_t before_ns = realtime_ns();
    publish_bytes(*publisher, sent);
    REQUIRE(subscription->has_data());
    const std::optional<Claim> claim = subscription->claim();
    REQUIRE(claim);
    CHECK(std::equal(sent.begin(), sent.end(), claim->data(), claim->data() + claim->size()));
    CHECK(claim->info().source_timestamp_ns >= before_ns);
    CHECK(claim->info().received_timestamp_ns >= claim->info().source_timestamp_ns);
    CHECK(claim->info().publication_sequence_number == number);
    CHECK(claim->info().reception_sequence_number == number);
    CHECK(claim->info().publisher == publisher->gid());
    CHECK(claim->info().from_this_process);
  }
  CHECK_FALSE(subscription->has_data());
  CHECK(subscription->lost() == 0);
}

TEST_CASE("a dropped draft sends nothing, and its room is reused") {
  Fixture f;
  const auto publisher = f.publisher("/draft", keep_last(10));
  const auto subscription = f.subscription("/draft", keep_last(10));
  const uint8_t * first = nullptr;
  {
    const Draft draft = publisher->draft(1000);
    first = draft.data();
    CHECK(draft.capacity() >= 1000);
  }
  CHECK_FALSE(subscription->has_data());
  CHECK(publisher->draft(1000).data() == first);
  CHECK(publish(*publisher, 1) == 1);
  CHECK(take_all(*subscription) == numbers(1, 1));
}

TEST_CASE("early release: a stream whose reader keeps up stays in the same bytes") {
  Fixture f;
  const auto publisher = f.publisher("/stream", keep_last(10));
  const auto subscription = f.subscription("/stream", keep_last(10));
  const uint8_t * const first = publisher->draft(64).data();
  for (uint64_t number = 1; number <= 500; ++number) {
    Draft draft = publisher->draft(64);
    REQUIRE(draft.data() == first);
    Payload{1, number, 64}.write(draft.data());
    publisher->publish(std::move(draft), 64, realtime_ns());
    REQUIRE(take(*subscription)->number == number);
  }
  CHECK(f.inspection.generations_of(*publisher) == 1);
}

TEST_CASE("without readers nothing is kept and nothing grows") {
  Fixture f;
  const auto publisher = f.publisher("/alone", keep_last(1000));
  for (uint64_t number = 1; number <= 2000; ++number) {
    publish(*publisher, number);
  }
  CHECK(f.inspection.generations_of(*publisher) == 1);
  CHECK(f.counters(*publisher).overwritten == 0);
}

TEST_CASE("a lagging reader makes the topic DSM grow; what it has taken is freed") {
  Fixture f;
  const Standstill receive_thread(f.platform, 1);  // a reaper's hold would postpone the freeing
  const auto publisher = f.publisher("/growing", keep_last(10));
  const auto subscription = f.subscription("/growing", keep_last(100));
  const uint64_t used_before = f.inspection.used_bytes();
  for (uint64_t number = 1; number <= 100; ++number) {
    publish(*publisher, number, 1000);
  }
  CHECK(f.inspection.generations_of(*publisher) > 1);
  CHECK(f.inspection.used_bytes() > used_before + 100 * 1000);
  CHECK(take_all(*subscription) == numbers(1, 100));
  publish(*publisher, 101);
  CHECK(f.inspection.generations_of(*publisher) == 1);
  CHECK(take_all(*subscription) == numbers(101, 101));
}

TEST_CASE("any depth is held, whatever the sizes of the messages") {
  Fixture f;
  for (const size_t size : {size_t{40}, size_t{1000}, size_t{20'000}}) {
    for (const uint32_t depth : {17u, 300u, 1000u}) {
      CAPTURE(size);
      CAPTURE(depth);
      const auto publisher = f.publisher("/deep", keep_last(1));
      const auto subscription = f.subscription("/deep", keep_last(depth));
      for (uint64_t number = 1; number <= depth + 5; ++number) {
        publish(*publisher, number, size);
      }
      CHECK(take_all(*subscription) == numbers(6, depth + 5));
      CHECK(f.counters(*publisher).overwritten == 0);
    }
  }
}

TEST_CASE(
  "a fixed topic DSM wraps around and overwrites the oldest, which is counted on both sides") {
  Fixture f(1000);  // not a multiple of the record size
  const auto publisher = f.publisher("/fixed", keep_last(10));
  const auto subscription = f.subscription("/fixed", keep_last(100));
  const uint64_t used = f.inspection.used_bytes();
  for (uint64_t number = 1; number <= 100; ++number) {
    publish(*publisher, number, 100 + number % 7 * 20);
  }
  const std::vector<uint64_t> taken = take_all(*subscription);
  CHECK(f.inspection.used_bytes() == used);
  REQUIRE(taken.size() >= 3);
  CHECK(taken == numbers(101 - taken.size(), 100));
  CHECK(subscription->lost() == 100 - taken.size());
  CHECK(f.counters(*publisher).overwritten == 100 - taken.size());
}

TEST_CASE("a take that finds losses wakes those that wait for the event") {
  Fixture f(1000);
  const auto publisher = f.publisher("/fixed", keep_last(10));
  const auto subscription = f.subscription("/fixed", keep_last(100));
  for (uint64_t number = 1; number <= 100; ++number) {
    publish(*publisher, number, 100);
  }
  f.process->waiters().event_watchers().add(callback_word);  // which arrivals do not wake
  const Waiter & waiter = f.process->waiters().of_word(callback_word);
  const uint32_t before = waiter.epoch();
  CHECK(subscription->lost() == 0);  // only a take finds them
  REQUIRE(take(*subscription));
  CHECK(subscription->lost() != 0);
  CHECK(waiter.epoch() == before + 1);
  REQUIRE(take(*subscription));
  CHECK(waiter.epoch() == before + 1);
}

TEST_CASE("a message beyond topic_dsm_size is refused with the size it needs") {
  Fixture f(1000);
  const auto publisher = f.publisher("/fixed", keep_last(10));
  const auto subscription = f.subscription("/fixed", keep_last(10));
  const Refusal refusal = refusal_of([&] { publisher->draft(5000); });
  CHECK(refusal.code == ErrorCode::too_large);
  CHECK(refusal.says("/fixed"));
  CHECK(refusal.says("topic_dsm_size to at least 50"));
  CHECK(f.counters(*publisher).refused == 1);
  publish(*publisher, 1, 1000);
  CHECK(take_all(*subscription) == numbers(1, 1));
}

TEST_CASE("a message beyond the cluster's SMEM is refused, and the next one is not") {
  TestPlatform platform;
  Profile profile = host_profile();
  profile.smem_bytes = 8 << 20;
  const Configurator configurator(platform.name(), profile, {});
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/huge", keep_last(10)));
  const Refusal refusal = refusal_of([&] { publisher->draft(profile.smem_bytes); });
  CHECK(refusal.code == ErrorCode::too_large);
  CHECK(refusal.says("SMEM"));
  CHECK(publish(*publisher, 1) == 1);
}

TEST_CASE("a message of more than 4 GiB is refused, not cut") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(1)));
  const Refusal refusal = refusal_of([&] { publisher->draft((size_t{1} << 32) + 8); });
  CHECK(refusal.code == ErrorCode::too_large);
  CHECK(refusal.says("larger than 4 GiB"));
  publish(*publisher, 1);
}

TEST_CASE("a claimed record stays unchanged while the publisher laps the ring") {
  for (const std::string topic : {"/fixed", "/growing"}) {
    CAPTURE(topic);
    Fixture f(1000);
    const auto publisher = f.publisher(topic, keep_last(10));
    const auto holder = f.subscription(topic, keep_last(2));
    const auto follower = f.subscription(topic, keep_last(2));
    publish(*publisher, 1, 300);
    CHECK(take_all(*follower) == numbers(1, 1));
    {
      const std::optional<Claim> claim = holder->claim();
      REQUIRE(claim);
      for (uint64_t number = 2; number <= 100; ++number) {
        publish(*publisher, number, 40 + number % 9 * 30);
        REQUIRE(take(*follower)->number == number);
      }
      CHECK(Payload::read(claim->data(), claim->size()).number == 1);
    }
    CHECK(take_all(*holder) == numbers(99, 100));
  }
}

TEST_CASE("once released, the bytes of a claimed record are reused") {
  Fixture f(1024);
  const auto publisher = f.publisher("/fixed", keep_last(1));
  const auto subscription = f.subscription("/fixed", keep_last(1));
  publish(*publisher, 1, 512);
  {
    const std::optional<Claim> claim = subscription->claim();
    REQUIRE(claim);
    const Refusal refusal = refusal_of([&] { publish(*publisher, 2, 1024); });
    CHECK(refusal.code == ErrorCode::no_space);
    CHECK(refusal.says("topic_dsm_size"));
    CHECK(Payload::read(claim->data(), claim->size()).number == 1);
  }
  publish(*publisher, 3, 1024);
  CHECK(take_all(*subscription) == numbers(3, 3));
}

TEST_CASE("claims on many records at once: each stays, the publisher uses what is left") {
  Fixture f(64 * 40);
  const auto publisher = f.publisher("/fixed", keep_last(1));
  std::vector<std::unique_ptr<Subscription>> holders;
  std::vector<Claim> claims;
  for (uint64_t number = 1; number <= 10; ++number) {
    holders.push_back(f.subscription("/fixed", keep_last(1)));
    publish(*publisher, number, 64);
    claims.push_back(holders.back()->claim().value());
    publish(*publisher, 1000 + number, 64);
  }
  for (uint64_t number = 1; number <= 200; ++number) {
    publish(*publisher, 2000 + number, 64);
  }
  for (uint64_t i = 0; i < claims.size(); ++i) {
    CHECK(Payload::read(claims[i].data(), claims[i].size()).number == i + 1);
  }
}

TEST_CASE("an expired message is not delivered, and does not hold up the others") {
  Fixture f;
  Qos qos = keep_last(10);
  qos.lifespan_ns = ns_per_s * 3600;
  const auto publisher = f.publisher("/lifespan", qos);
  const auto subscription = f.subscription("/lifespan", keep_last(10));
  const int64_t now = realtime_ns();
  for (const int64_t age_ns : {int64_t{0}, 2 * qos.lifespan_ns, int64_t{0}}) {
    publisher->publish(publisher->draft(8), 8, now - age_ns);
  }
  CHECK(subscription->claim()->info().publication_sequence_number == 1);
  CHECK(subscription->claim()->info().publication_sequence_number == 3);
  CHECK_FALSE(subscription->claim());
  CHECK(subscription->lost() == 0);
}
