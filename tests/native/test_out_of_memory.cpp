// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A process has no memory for the list of a publisher's readers, or of a subscription's records: a
// message is refused, or reaches all readers.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <future>
#include <new>
#include <vector>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

thread_local uint64_t allocations_left = UINT64_MAX;

/// Lets allocations of this thread fail during its lifetime, after some that succeed.
class NoMemory {
public:
  explicit NoMemory(uint64_t after) { allocations_left = after; }
  ~NoMemory() { allocations_left = UINT64_MAX; }
  NoMemory(const NoMemory &) = delete;
  NoMemory & operator=(const NoMemory &) = delete;
};

template<typename Act>
bool lacks_memory(const Act & act, uint64_t after = 0) {
  const NoMemory none(after);
  try {
    act();
  } catch (const std::bad_alloc &) {
    return true;
  }
  return false;
}

struct Fixture {
  std::unique_ptr<Subscription> subscription(const std::string & topic = "/x") {
    return process->create_subscription(on_topic(topic, keep_all()));
  }
  std::unique_ptr<Publisher> publisher_on(const std::string & topic) {
    return process->create_publisher(on_topic(topic, keep_all()));
  }
  bool is_in_phase() { return inspection.header_of(*publisher).phase.load() % 2 != 0; }

  TestPlatform platform;
  Configurator configurator{platform.name(), host_profile(), {{"/fixed", 1, 1024, 0}}};
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
  Standstill receive_thread{platform, 1};
  std::unique_ptr<Publisher> publisher = publisher_on("/x");
  std::unique_ptr<Subscription> first = subscription();
};

}  // namespace

// Not inlined: g++ would warn that free() gets memory of another allocation function.
[[gnu::noinline]] void * operator new(size_t size) {
  void * const memory = allocations_left != 0 ? std::malloc(size) : nullptr;
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  allocations_left -= allocations_left != UINT64_MAX ? 1 : 0;
  return memory;
}

[[gnu::noinline]] void operator delete(void * memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void * memory, size_t) noexcept { std::free(memory); }

TEST_CASE("without memory for new readers a publish is refused, and the next one reaches all") {
  Fixture f;
  publish(*f.publisher, 1);
  const auto second = f.subscription();
  CHECK(lacks_memory([&] { f.publisher->draft(sizeof(Payload)); }));
  CHECK_FALSE(f.is_in_phase());
  publish(*f.publisher, 2);
  CHECK(take_all(*f.first) == numbers(1, 2));
  CHECK(take_all(*second) == numbers(2, 2));
}

TEST_CASE("a record begun before memory ran out reaches the readers that came meanwhile") {
  Fixture f;
  publish(*f.publisher, 1);
  Draft draft = f.publisher->draft(sizeof(Payload));
  Payload{1, 2, sizeof(Payload)}.write(draft.data());
  const auto second = f.subscription();
  CHECK_FALSE(
    lacks_memory([&] { f.publisher->publish(std::move(draft), sizeof(Payload), realtime_ns()); }));
  CHECK_FALSE(f.is_in_phase());
  CHECK(take_all(*f.first) == numbers(1, 2));
  CHECK(take_all(*second) == numbers(2, 2));
  publish(*f.publisher, 3);
  CHECK(take_all(*second) == numbers(3, 3));
}

TEST_CASE("RELIABLE + KEEP_ALL: memory that runs out while a publisher waits costs no message") {
  Fixture f;
  const auto publisher = f.publisher_on("/fixed");
  const auto reader = f.subscription("/fixed");
  uint64_t last = 0;
  while (!refusal_of([&] { publish(*publisher, last + 1, 100); }).code) {
    ++last;
  }
  auto refused =
    std::async(std::launch::async, [&] { return lacks_memory([&] { publisher->draft(100); }); });
  wait_until("the publisher waits, or has given up", [&] {
    return f.inspection.header_of(*publisher).writer_waits.load() != 0 ||
           refused.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  const auto late = f.subscription("/fixed");
  CHECK(refused.get());
  CHECK(take_all(*reader) == numbers(1, last));
  CHECK(reader->lost() == 0);
}

TEST_CASE("memory that runs out anywhere in a resync costs no message") {
  constexpr uint64_t more_than_a_resync_makes = 20;
  for (uint64_t allocations = 0; allocations <= more_than_a_resync_makes; ++allocations) {
    CAPTURE(allocations);
    Fixture f;
    const auto second = f.publisher_on("/x");
    publish(*f.publisher, 1);
    publish(*second, 2);
    publish(*f.publisher, 3);
    f.inspection.header_of(*f.first).resync.store(1);
    CHECK_FALSE(lacks_memory([&] { f.first->arrivals(); }, allocations));
    const bool was_enough = !f.first->has_to_resync();
    CHECK((allocations != 0 || !was_enough));
    CHECK((allocations != more_than_a_resync_makes || was_enough));
    if (!was_enough) {
      CHECK(lacks_memory([&] { f.first->claim(); }));
    }
    CHECK(f.first->arrivals() == 3);
    std::vector<uint64_t> taken = take_all(*f.first);
    std::sort(taken.begin(), taken.end());  // a publisher that could not be listed comes later
    CHECK(taken == numbers(1, 3));
    CHECK(f.first->lost() == 0);
  }
}
