// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What does a message for one thread cost a process in which many threads wait, each for its own
// topic?
//
//   composition role=sink threads=N messages=N
//   composition role=source threads=N messages=N rate_hz=N
//
// The sink counts the context switches of its threads and its CPU time, for all messages except the
// first two of the first thread. It ends when its input ends.
#include <sys/resource.h>

#include <memory>
#include <thread>

#include "bench/node.hpp"
#include "bench/program.hpp"

namespace {

using namespace manycore::bench;

/// For all threads to take their first message and wait again, before messages count.
constexpr std::chrono::milliseconds settle_time{200};
/// For all threads that a message woke to sleep again, before the next one comes.
constexpr std::chrono::milliseconds rest_time{2};

std::string topic(size_t thread) { return "/composed_" + std::to_string(thread); }

/// Holds all messages, including the first and the last, so a thread may be without CPU for any
/// time.
rmw_qos_profile_t qos(const Arguments & arguments) {
  return reliable_qos(arguments.number("messages") + 2);
}

struct Costs {
  uint64_t sleeps;
  uint64_t cpu_ns;
};

uint64_t nanoseconds(const timeval & time) {
  return static_cast<uint64_t>(time.tv_sec) * 1'000'000'000 +
         static_cast<uint64_t>(time.tv_usec) * 1'000;
}

Costs costs_now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {
    static_cast<uint64_t>(usage.ru_nvcsw),
    nanoseconds(usage.ru_utime) + nanoseconds(usage.ru_stime)};
}

void source(const Arguments & arguments) {
  Node node("source");
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (size_t i = 0; i < arguments.number("threads"); ++i) {
    publishers.push_back(std::make_unique<Publisher>(node, topic(i), qos(arguments)));
    wait_until_matched(*publishers.back(), 1);
  }
  Message message;
  message.data.resize(64);
  for (const auto & publisher : publishers) {
    publisher->publish(message);
  }
  const std::chrono::nanoseconds period(1'000'000'000 / arguments.number("rate_hz"));
  auto next = std::chrono::steady_clock::now() + settle_time;
  for (size_t i = 0; i < arguments.number("messages"); ++i) {
    std::this_thread::sleep_until(next += period);
    publishers.front()->publish(message);
  }
  std::this_thread::sleep_until(next += period);
  for (const auto & publisher : publishers) {
    stop_subscribers(*publisher);
  }
}

/// After a rest, so that each thread that a message woke counts for this message, and not for the
/// next. The rest itself counts as a sleep.
Costs costs_after_rest() {
  std::this_thread::sleep_for(rest_time);
  return costs_now();
}

/// Takes messages until the empty one. The first two are not counted.
void take_all(Node & node, Subscription & subscription, size_t messages, Costs & spent) {
  WaitSet wait_set(node);
  Message message;
  Costs start{};
  for (size_t taken = 0;; ++taken) {
    take_next(wait_set, subscription, message);
    if (message.data.empty()) {
      return;
    }
    if (taken == 0) {
      continue;
    }
    if (taken == 1) {
      start = costs_after_rest();
    }
    if (taken == messages) {
      const Costs end = costs_after_rest();
      spent = {end.sleeps - start.sleeps - 1, end.cpu_ns - start.cpu_ns};
    }
  }
}

void sink(const Arguments & arguments) {
  Node node("sink");
  const size_t messages = arguments.number("messages");
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  std::vector<Costs> spent(arguments.number("threads"));
  std::vector<std::thread> threads;
  for (size_t i = 0; i < spent.size(); ++i) {
    subscriptions.push_back(std::make_unique<Subscription>(node, topic(i), qos(arguments)));
  }
  announce_ready();
  for (size_t i = 0; i < spent.size(); ++i) {
    threads.emplace_back([&, i] {
      take_all(node, *subscriptions[i], messages, spent[i]);
      subscriptions[i].reset();  // the source waits for this
    });
  }
  for (std::thread & thread : threads) {
    thread.join();
  }
  if (spent[0].cpu_ns == 0) {
    throw std::runtime_error("a message was lost");
  }
  print_samples({}, {{"sleeps", spent[0].sleeps}, {"cpu_ns", spent[0].cpu_ns}});
  wait_for_end_of_input();
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    arguments.text("role") == "source" ? source(arguments) : sink(arguments);
  });
}
