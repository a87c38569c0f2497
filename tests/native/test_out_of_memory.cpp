// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A publisher whose process has no memory for the list of its readers: a message is refused, or
// reaches all readers, and the publisher's phase ends.
#include <doctest/doctest.h>

#include <cstdlib>
#include <future>
#include <new>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

thread_local bool may_allocate = true;

/// Lets allocations of this thread fail during its lifetime.
class NoMemory {
public:
  NoMemory() { may_allocate = false; }
  ~NoMemory() { may_allocate = true; }
  NoMemory(const NoMemory &) = delete;
  NoMemory & operator=(const NoMemory &) = delete;
};

template<typename Act>
bool lacks_memory(const Act & act) {
  const NoMemory none;
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
  void * const memory = may_allocate ? std::malloc(size) : nullptr;
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
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
