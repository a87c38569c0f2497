// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Which threads of a process a message wakes. An unchanged epoch wakes no thread, so the tests
// compare epochs; test_waiter shows that a changed epoch does wake.
#include <doctest/doctest.h>

#include <csignal>
#include <future>
#include <list>
#include <memory>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform/clock.hpp"
#include "platform_of_test.hpp"
#include "transport/waiting/thread_number.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

/// A thread that waits for some subscriptions like rmw_wait, and does nothing else.
class WaitingThread {
public:
  WaitingThread(Process & process, const std::vector<Subscription *> & awaited)
  : thread_([this, &process, awaited] {
      waiter_ = &process.waiters().of_this_thread();
      word_ = Waiters::word_of_this_thread();
      for (Subscription * const subscription : awaited) {
        subscription->watchers().add(word_);
      }
      started_.set_value();
      ended_.get_future().wait();
    }) {
    started_.get_future().wait();
    seen_ = waiter_->epoch();
  }
  ~WaitingThread() {
    ended_.set_value();
    thread_.join();
  }
  WaitingThread(const WaitingThread &) = delete;
  WaitingThread & operator=(const WaitingThread &) = delete;

  uint32_t word() const noexcept { return word_; }
  /// Since the previous call.
  uint32_t wake_ups() noexcept {
    const uint32_t epoch = waiter_->epoch();
    return epoch - std::exchange(seen_, epoch);
  }

private:
  Waiter * waiter_ = nullptr;
  uint32_t word_ = 0;
  uint32_t seen_ = 0;
  std::promise<void> started_;
  std::promise<void> ended_;
  std::thread thread_;
};

/// A process with a subscription on each of many topics.
struct Fixture {
  explicit Fixture(uint32_t subscriptions_count) {
    platform.receive_thread(1);  // it wakes all threads when it starts
    for (uint32_t i = 0; i < subscriptions_count; ++i) {
      subscriptions.push_back(process->create_subscription(on_topic(topic(i), keep_last(10))));
      subscriptions.back()->watchers().reset();
    }
  }
  static std::string topic(uint32_t i) { return "/wake_" + std::to_string(i); }
  std::vector<Subscription *> from(uint32_t first, uint32_t count) const {
    std::vector<Subscription *> some;
    for (uint32_t i = first; i < first + count; ++i) {
      some.push_back(subscriptions[i].get());
    }
    return some;
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  std::vector<std::unique_ptr<Subscription>> subscriptions;
};

std::vector<std::unique_ptr<WaitingThread>> one_thread_each(const Fixture & f) {
  std::vector<std::unique_ptr<WaitingThread>> threads;
  for (uint32_t i = 0; i < f.subscriptions.size(); ++i) {
    threads.push_back(std::make_unique<WaitingThread>(*f.process, f.from(i, 1)));
  }
  return threads;
}

}  // namespace

TEST_CASE("a message wakes the thread that waits for it, and no other") {
  Fixture f(32);
  const auto threads = one_thread_each(f);
  // Kept alive: one that ends wakes its readers.
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (uint32_t i = 0; i < threads.size(); ++i) {
    publishers.push_back(f.process->create_publisher(on_topic(Fixture::topic(i), keep_last(10))));
    publish(*publishers.back(), 1);
    for (uint32_t other = 0; other < threads.size(); ++other) {
      CHECK(threads[other]->wake_ups() == (other == i ? 1 : 0));
    }
  }
}

TEST_CASE("a message from another cluster wakes the thread that waits for it, and no other") {
  Fixture f(3);
  const auto threads = one_thread_each(f);
  std::list<Node> publishers;
  for (uint32_t i = 0; i < threads.size(); ++i) {
    Node & publisher = publishers.emplace_back(f.platform, 2);
    publisher.tell("publisher " + Fixture::topic(i) + " 10");
    publisher.tell("publish 1 1 1");
    wait_until("its arrival", [&] { return f.subscriptions[i]->has_data(); });
    wait_until("its wake-up", [&] { return threads[i]->wake_ups() == 1; });
    for (const auto & thread : threads) {
      CHECK(thread->wake_ups() == 0);
    }
  }
}

TEST_CASE("a message wakes a thread once, however many subscriptions it reaches") {
  for (const uint32_t publisher_cluster : {1, 2}) {
    Fixture f(0);
    for (int i = 0; i < 5; ++i) {
      f.subscriptions.push_back(f.process->create_subscription(on_topic("/many", keep_last(10))));
      f.subscriptions.back()->watchers().reset();
    }
    WaitingThread thread(*f.process, f.from(0, 5));
    Node publisher(f.platform, publisher_cluster);
    publisher.tell("publisher /many 10");
    publisher.tell("publish 1 1 1");
    wait_until("a wake-up", [&] { return thread.wake_ups() == 1; });
    // The receive thread wakes the thread after all five pushes; a second wake-up would have come
    // by now.
    for (const auto & subscription : f.subscriptions) {
      CHECK(subscription->has_data());
    }
    CHECK(thread.wake_ups() == 0);
  }
}

TEST_CASE(
  "threads that wait for events are woken by the first message and by displaced ones only") {
  Fixture f(0);
  Qos qos = keep_last(1);
  qos.deadline_ns = 3600 * ns_per_s;
  f.subscriptions.push_back(f.process->create_subscription(on_topic("/timed", qos)));
  f.subscriptions.back()->watchers().reset();
  WaitingThread thread(*f.process, {});
  f.process->waiters().event_watchers().add(thread.word());
  const auto publisher = f.process->create_publisher(on_topic("/timed", qos));
  CHECK(thread.wake_ups() != 0);  // a match
  publish(*publisher, 1);
  CHECK(thread.wake_ups() != 0);  // a deadline just started
  CHECK(take(*f.subscriptions[0]));
  publish(*publisher, 2);
  CHECK(thread.wake_ups() == 0);
  publish(*publisher, 3);
  CHECK(thread.wake_ups() != 0);  // the second message was lost
}

TEST_CASE("a forgotten entity does not wake the thread any more") {
  Fixture f(2);
  const Watched first(f.process->waiters(), f.subscriptions[0]->watchers());
  const Watched second(f.process->waiters(), f.subscriptions[1]->watchers());
  WaitingThread other(*f.process, f.from(0, 2));
  Waiter & own = f.process->waiters().of_this_thread();
  const uint32_t word = Waiters::word_of_this_thread();
  for (Watchers * const watchers :
       {&first.watchers(), &second.watchers(), &f.process->waiters().event_watchers()}) {
    watchers->add(word);
  }
  f.process->waiters().watch_graph(word);
  f.process->waiters().forget_this_thread();
  second.watchers().add(word);
  const auto unread = f.process->create_publisher(on_topic(Fixture::topic(0), keep_last(10)));
  const auto awaited = f.process->create_publisher(on_topic(Fixture::topic(1), keep_last(10)));
  const uint32_t seen = own.epoch();
  publish(*unread, 1);
  CHECK(own.epoch() == seen);
  CHECK(other.wake_ups() == 1);
  publish(*awaited, 1);
  CHECK(own.epoch() == seen + 1);
  CHECK(other.wake_ups() == 1);
}

TEST_CASE("a change of the graph looks at processes that have ever watched it, and no others") {
  Fixture f(0);
  Inspection inspection(f.platform);
  RegistryHeader & header = inspection.registry().header();
  Table<ProcessEntry> & processes = inspection.registry().processes();
  WaitingThread thread(*f.process, {});
  const auto change_graph = [&] { f.process->remove_node(f.process->add_node("node", "/", "/")); };
  CHECK_FALSE(header.graph_watchers.contains(0));
  processes[0].wake.graph.add(thread.word());  // without its process
  change_graph();
  CHECK(thread.wake_ups() == 0);
  f.process->waiters().watch_graph(thread.word());
  CHECK(header.graph_watchers.contains(0));
  change_graph();
  CHECK(thread.wake_ups() == 2);
  processes[0].wake.graph.remove(thread.word());
  change_graph();
  CHECK(thread.wake_ups() == 0);
  CHECK(header.graph_watchers.contains(0));  // another thread may wait
}

TEST_CASE("a slot that is given back, or taken anew, does not watch the graph") {
  Fixture f(0);
  Inspection inspection(f.platform);
  GraphWatchers & watchers = inspection.registry().header().graph_watchers;
  {
    Node watching(f.platform, 1);
    watchers.add(1);
  }
  wait_until("the node has left", [&] { return inspection.live_processes() == 1; });
  CHECK_FALSE(watchers.contains(1));
  watchers.add(1);  // a process that was taken for dead does so
  const Node next(f.platform, 1);
  CHECK_FALSE(watchers.contains(1));
}

TEST_CASE("a publisher spares words of its own process, but not from events") {
  Fixture f(1);
  Watchers & watchers = f.subscriptions[0]->watchers();
  const Waiter & waiter = f.process->waiters().of_word(callback_word);
  WaitingThread thread(*f.process, f.from(0, 1));
  watchers.add(callback_word);
  const auto publisher = f.process->create_publisher(on_topic(Fixture::topic(0), keep_last(10)));
  uint32_t seen = waiter.epoch();
  const auto wake_ups = [&] { return waiter.epoch() - std::exchange(seen, waiter.epoch()); };
  const auto publish_sparing = [&] {
    publisher->publish(publisher->draft(8), 8, realtime_ns(), {}, WakeSet::of(callback_word));
  };

  publish_sparing();
  CHECK(wake_ups() == 0);
  CHECK(thread.wake_ups() == 1);
  publish(*publisher, 1);
  CHECK(wake_ups() == 1);
  f.process->waiters().event_watchers().add(callback_word);
  publish_sparing();
  CHECK(wake_ups() == 0);
  for (int i = 0; i < 8; ++i) {
    publish_sparing();  // the last one displaces the first: a loss
  }
  CHECK(wake_ups() == 1);
}

TEST_CASE("a notifier marks what the thread on the callback word has to look at") {
  Fixture f(3);
  CallbackMarks & marks = f.process->waiters().callback_marks();
  const auto marked = [&] {
    std::vector<uint32_t> found;
    marks.take().for_each_mark([&](uint32_t mark) { found.push_back(mark); });
    return found;
  };
  const auto mark_of = [&](uint32_t i) {
    return CallbackMarks::of(static_cast<uint32_t>(endpoint_in(f.subscriptions[i]->gid())));
  };
  CHECK(marks.take().events);  // nothing was looked at yet
  CHECK(marked().empty());
  f.subscriptions[0]->watchers().add(callback_word);
  f.subscriptions[1]->watchers().add(callback_word);
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (uint32_t i = 0; i < 3; ++i) {
    publishers.push_back(f.process->create_publisher(on_topic(Fixture::topic(i), keep_last(10))));
  }

  SUBCASE("from its cluster") {
    publish(*publishers[1], 1);
    CHECK(marked() == std::vector{mark_of(1)});
    publish(*publishers[2], 1);  // no callback
    CHECK(marked().empty());
  }
  SUBCASE("from another cluster") {
    Node other(f.platform, 2);
    other.tell("publisher " + Fixture::topic(0) + " 10");
    other.tell("publish 1 1 8");
    wait_until("the message is here", [&] { return f.subscriptions[0]->waiting() == 1; });
    wait_until("it is marked", [&] { return marked() == std::vector{mark_of(0)}; });
  }
  SUBCASE("from the reaper of a publisher, if something is left to take") {
    Node other(f.platform, 1);
    other.tell("publisher " + Fixture::topic(0) + " 10");
    other.tell("publish 1 1 8");
    CHECK(marked() == std::vector{mark_of(0)});
    other.kill();
    wait_until("it is marked", [&] { return marked() == std::vector{mark_of(0)}; });
  }
  SUBCASE("a loss is an event") {
    f.process->waiters().event_watchers().add(callback_word);
    for (uint64_t number = 1; number <= 10; ++number) {
      publish(*publishers[2], number);
    }
    CHECK_FALSE(marks.take().events);
    publish(*publishers[2], 11);
    CHECK(marks.take().events);
  }
  SUBCASE("a new receive thread has the whole cluster look") {
    kill(f.platform.receive_thread(1), SIGKILL);
    std::set<uint32_t> all;  // a look may come between the stores
    wait_until("everything is marked", [&] {
      const std::vector<uint32_t> found = marked();
      all.insert(found.begin(), found.end());
      return all.size() == CallbackMarks::count;
    });
  }
}

TEST_CASE("threads share words when there are too few, but none that a thread may forget") {
  Fixture f(1);
  Watchers & watchers = f.subscriptions[0]->watchers();
  const Watched watched(f.process->waiters(), watchers);
  const auto publisher = f.process->create_publisher(on_topic(Fixture::topic(0), keep_last(10)));
  const uint32_t own = Waiters::word_of_this_thread();
  std::vector<std::unique_ptr<WaitingThread>> alone;
  WakeSet unique = WakeSet::of(own);
  while (unique.count() < unique_thread_numbers) {
    alone.push_back(std::make_unique<WaitingThread>(*f.process, f.from(0, 1)));
    REQUIRE_FALSE(unique.contains(alone.back()->word()));
    unique |= WakeSet::of(alone.back()->word());
  }
  std::vector<std::unique_ptr<WaitingThread>> sharing;
  WakeSet shared;
  for (uint32_t i = 0; i < 2 * (thread_numbers - unique_thread_numbers); ++i) {
    sharing.push_back(std::make_unique<WaitingThread>(*f.process, f.from(0, 1)));
    shared |= WakeSet::of(sharing.back()->word());
  }
  CHECK(shared.without(unique).count() == thread_numbers - unique_thread_numbers);
  CHECK(shared.without(unique).parts == shared.parts);

  watchers.add(own);
  f.process->waiters().forget_this_thread();
  CHECK_FALSE(watchers.read().contains(own));
  std::thread([&] {  // shares a word
    f.process->waiters().forget_this_thread();
  })
    .join();
  publish(*publisher, 1);
  for (const auto & thread : alone) {
    CHECK(thread->wake_ups() == 1);
  }
  for (const auto & thread : sharing) {
    CHECK(thread->wake_ups() == 1);
  }
  alone.clear();
  const WaitingThread later(*f.process, {});
  CHECK(unique.contains(later.word()));  // the numbers were returned
}
