// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Generations of a growing topic DSM that readers pin: a stopped reader pins at most what it was
// reading. Where readers pin all of them, the error names the subscriptions.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "stepped_child.hpp"
#include "transport/peers/peers.hpp"
#include "transport/queue/reading.hpp"

using namespace manycore;

namespace {

constexpr const char * topic = "/grows";
constexpr uint32_t depth = 2;

/// Takes messages published before and after its match.
const Role reads("reads_generations", [](Lines &, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto subscription = process->create_subscription(on_topic(topic, transient_local(depth)));
  begin_steps();
  take_all(*subscription);  // throws if a message is torn
  finish_steps();
});

/// Publishes `of_each_size` messages of each of growing sizes, until one is refused. The sizes need
/// more generations than a topic DSM has.
Refusal refusal_of_growth(Publisher & publisher, uint64_t & number, uint32_t of_each_size) {
  return refusal_of([&] {
    for (double size = 2050; size < min_chunk_message_bytes; size *= 1.502) {
      for (uint32_t i = 0; i < of_each_size; ++i) {
        publish(publisher, ++number, static_cast<size_t>(size));
      }
    }
  });
}

struct Fixture {
  explicit Fixture(const Qos & qos) : publisher(process->create_publisher(on_topic(topic, qos))) {}

  /// The child's subscription, the only reader.
  SubscriptionHeader & reader() {
    Registry & registry = inspection.registry();
    return *registry.clusters().find<SubscriptionHeader>(
      inspection.readers_of(*publisher).at(0).block);
  }
  uint64_t header_only() {
    const uint32_t slot = inspection.slot_of(publisher->gid());
    return Reading::header_only(slot, inspection.registry().endpoints()[slot].slot.incarnation);
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  std::unique_ptr<Publisher> publisher;
  uint64_t published = 0;
};

/// Stops a reader in a take, at its `stores`-th store to `reading`. False if the take ended before.
bool stop_reader(SteppedChild & reader, const std::atomic<uint64_t> & reading, int stores) {
  for (uint64_t before = reading; stores != 0;) {
    if (reader.step(1) == 0) {
      return false;
    }
    const uint64_t now = reading;
    stores -= now == before ? 0 : 1;
    before = now;
  }
  return true;
}

}  // namespace

TEST_CASE("wherever a reader stops in a look or a claim, messages may grow") {
  bool is_over = false;
  int kept = 0;
  for (int stores = 1; !is_over; ++stores) {
    CAPTURE(stores);
    Fixture f(transient_local(depth));
    publish(*f.publisher, ++f.published);
    SteppedChild reader("reads_generations", {f.platform.name()});
    publish(*f.publisher, ++f.published);
    const std::atomic<uint64_t> & reading = f.reader().reading;
    f.reader().resync.store(1);  // for a scan before the claims
    is_over = !stop_reader(reader, reading, stores);
    const GenerationEntry & generation = f.inspection.header_of(*f.publisher).generations[0];
    const uint64_t offset = generation.offset;
    const uint64_t bytes = generation.data_bytes;
    const Refusal refusal = refusal_of_growth(*f.publisher, f.published, depth + 1);
    REQUIRE_MESSAGE(!refusal.code, refusal.text);
    const bool is_kept = reading != Reading::nothing && reading != f.header_only();
    kept += is_kept ? 1 : 0;
    CHECK((!is_kept || (generation.offset == offset && generation.data_bytes == bytes)));
    while (!reader.finished()) {  // its claimed record is still whole
      reader.run_to_system_call();
    }
    REQUIRE(stores < 100);
  }
  CHECK(kept > 3);  // a scan, and more than one claim
}

TEST_CASE("subscriptions that keep messages of each size are named, not the memory") {
  Fixture f(keep_last(1));
  const auto subscription = f.process->create_subscription(on_topic(topic, keep_last(1000)));
  const Refusal refusal = refusal_of_growth(*f.publisher, f.published, 1);
  CHECK(refusal.code == ErrorCode::too_large);
  CHECK_MESSAGE(refusal.says("subscriptions hold messages of 7 earlier sizes"), refusal.text);
  CHECK_FALSE_MESSAGE(refusal.says("/dev/shm"), refusal.text);
  CHECK(take_all(*subscription).size() + 1 == f.published);
  CHECK_FALSE(refusal_of([&] { publish(*f.publisher, 1, min_chunk_message_bytes - 1); }).code);
}
