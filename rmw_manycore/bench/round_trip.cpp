// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long does a round trip of a message take, at the rmw level?
//
//   round_trip role=pong
//   round_trip role=ping bytes=N warm_up=N iterations=N
#include "bench/ping_pong.hpp"
#include "bench/program.hpp"

namespace {

using namespace manycore::bench;

void ping(const Arguments & arguments) {
  Ping ping(arguments.number("bytes"));
  ping.connect();
  for (size_t i = 0; i < arguments.number("warm_up"); ++i) {
    ping.round_trip();
  }
  std::vector<int64_t> samples_ns(arguments.number("iterations"));
  for (int64_t & sample_ns : samples_ns) {
    sample_ns = ping.round_trip();
  }
  ping.stop();
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    if (arguments.text("role") == "ping") {
      ping(arguments);
    } else {
      run_pong([](uint64_t) {});
    }
  });
}
