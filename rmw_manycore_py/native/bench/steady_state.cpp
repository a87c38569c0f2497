// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How many page faults and allocations does a message cost once everything is warm?
//
//   steady_state role=pong warm_up=N iterations=N
//   steady_state role=ping warm_up=N iterations=N bytes=N
//
// Each process counts its own, all threads, over `iterations` round trips after `warm_up` ones;
// in each round trip it publishes one message and takes one.
#include <sys/resource.h>

#include "bench/allocation_counter.hpp"
#include "bench/ping_pong.hpp"
#include "bench/program.hpp"

namespace {

using namespace manycore::bench;

Counts counts_now() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto page_faults = static_cast<uint64_t>(usage.ru_minflt + usage.ru_majflt);
  return {{"allocations", allocations()}, {"page_faults", page_faults}};
}

Counts difference(Counts from, Counts to) {
  for (auto & [name, count] : to) {
    count -= from[name];
  }
  return to;
}

void ping(const Arguments & arguments) {
  Ping ping(arguments.number("bytes"));
  ping.connect();
  for (size_t i = 0; i < arguments.number("warm_up"); ++i) {
    ping.round_trip();
  }
  const Counts start = counts_now();
  for (size_t i = 0; i < arguments.number("iterations"); ++i) {
    ping.round_trip();
  }
  const Counts end = counts_now();
  ping.stop();
  print_samples({}, difference(start, end));
}

void pong(const Arguments & arguments) {
  const uint64_t first = arguments.number("warm_up") + 1;
  const uint64_t last = first + arguments.number("iterations") - 1;
  Counts start;
  Counts end;
  run_pong([&](uint64_t number) {
    if (number == first) {
      start = counts_now();
    }
    if (number == last) {
      end = counts_now();
    }
  });
  print_samples({}, difference(start, end));
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    arguments.text("role") == "ping" ? ping(arguments) : pong(arguments);
  });
}
