// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How many page faults and allocations does a message cost in the steady state?
//
//   steady_state role=pong warm_up=N iterations=N
//   steady_state role=ping warm_up=N iterations=N bytes=N
//
// Each process counts those of all its threads over `iterations` round trips after `warm_up` ones.
// In each round trip it publishes one message and takes one.
#include <sys/resource.h>

#include "bench/allocation_counter.hpp"
#include "bench/ping_pong.hpp"
#include "bench/program.hpp"

namespace {

using namespace manycore::bench;

/// Unlike Counts, copied without allocating, so that reading it is not counted.
struct Costs {
  uint64_t allocations;
  uint64_t page_faults;
};

Costs costs_now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {allocations(), static_cast<uint64_t>(usage.ru_minflt + usage.ru_majflt)};
}

void print_difference(const Costs & from, const Costs & to) {
  print_samples(
    {}, {{"allocations", to.allocations - from.allocations},
         {"page_faults", to.page_faults - from.page_faults}});
}

void ping(const Arguments & arguments) {
  Ping ping(arguments.number("bytes"));
  ping.connect();
  for (size_t i = 0; i < arguments.number("warm_up"); ++i) {
    ping.round_trip();
  }
  const Costs start = costs_now();
  for (size_t i = 0; i < arguments.number("iterations"); ++i) {
    ping.round_trip();
  }
  const Costs end = costs_now();
  ping.stop();
  print_difference(start, end);
}

void pong(const Arguments & arguments) {
  const uint64_t first = arguments.number("warm_up") + 1;
  const uint64_t last = first + arguments.number("iterations") - 1;
  Costs start{};
  Costs end{};
  run_pong([&](uint64_t number) {
    if (number == first) {
      start = costs_now();
    }
    if (number == last) {
      end = costs_now();
    }
  });
  print_difference(start, end);
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    arguments.text("role") == "ping" ? ping(arguments) : pong(arguments);
  });
}
