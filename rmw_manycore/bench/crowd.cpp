// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long does it take until many processes that start at one moment are all there?
//
//   crowd processes=N publishers=N clusters=N cpu_a=N cpu_b=N
//
// The processes, half of them on each CPU, wait for each other. Then each creates a context, a node
// and its publishers. The sample is the time until the last one has.
#include <deque>
#include <stdexcept>
#include <string>

#include "bench/node.hpp"
#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::futex_wait;
using manycore::futex_wake_all;
using manycore::FutexWord;
using manycore::monotonic_ns;

/// Shared with the processes of the crowd.
struct Moments {
  FutexWord start{0};
  FutexWord end{0};
  FutexWord waiting{0};
  FutexWord joined{0};
  FutexWord failed{0};
};

void wait_for(FutexWord & word) {
  while (word.load() == 0) {
    futex_wait(word, 0, std::nullopt);
  }
}

void set(FutexWord & word) {
  word.store(1);
  futex_wake_all(word);
}

/// The process waits for the others' end, too, so that none leaves while others join.
void join(Moments & moments, size_t number, const Arguments & arguments) {
  const size_t cluster = number % arguments.number("clusters") + 1;
  setenv("MANYCORE_CLUSTER", std::to_string(cluster).c_str(), 1);
  ++moments.waiting;
  wait_for(moments.start);
  try {
    Node node("crowd_" + std::to_string(number));
    std::deque<Publisher> publishers;
    for (size_t i = 0; i < arguments.number("publishers"); ++i) {
      publishers.emplace_back(node, "/crowd_" + std::to_string(i), reliable_qos(1));
    }
    ++moments.joined;
    wait_for(moments.end);
  } catch (const std::exception & error) {
    std::fprintf(stderr, "process %zu: %s\n", number, error.what());
    ++moments.failed;
  }
}

void wait_until(const FutexWord & count, size_t all, const FutexWord & failed) {
  const timespec pause{0, 1'000'000};
  while (count.load() < all) {
    if (failed.load() != 0) {
      throw std::runtime_error("a process of the crowd failed");
    }
    nanosleep(&pause, nullptr);
  }
}

void gather(const Arguments & arguments) {
  auto & moments = *new (shared_memory(sizeof(Moments))) Moments;
  const size_t count = arguments.number("processes");
  for (size_t number = 0; number < count; ++number) {
    const size_t cpu = arguments.number(number % 2 == 0 ? "cpu_a" : "cpu_b");
    fork_on(cpu, [&] { join(moments, number, arguments); });
  }
  wait_until(moments.waiting, count, moments.failed);
  const int64_t start_ns = monotonic_ns();
  set(moments.start);
  wait_until(moments.joined, count, moments.failed);
  const int64_t end_ns = monotonic_ns();
  set(moments.end);
  wait_for_children();
  print_samples({end_ns - start_ns});
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, gather); }
