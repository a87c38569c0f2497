// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What would a round trip cost on the bare machine? Peer of rmw_manycore inside a cluster.
//
//   futex_round_trip cpu_1=N cpu_2=N bytes=N warm_up=N iterations=N
//
// Two processes. Per direction: one copy into shared memory, one out of it, one futex wake-up.
#include <cstring>

#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

using Payload = std::vector<std::byte>;

void send(Slot & slot, const Payload & payload, uint32_t number) {
  std::memcpy(slot.payload(), payload.data(), payload.size());
  slot.announce(number);
}

void receive(Slot & slot, Payload & payload, uint32_t number) {
  slot.wait_for(number);
  std::memcpy(payload.data(), slot.payload(), payload.size());
}

void pong(Slot & there, Slot & back, size_t bytes, size_t messages) {
  Payload payload(bytes);
  for (uint32_t number = 1; number <= messages; ++number) {
    receive(there, payload, number);
    send(back, payload, number);
  }
}

int64_t round_trip(
  Slot & there, Slot & back, const Payload & sent, Payload & received, uint32_t number) {
  const int64_t start_ns = monotonic_ns();
  send(there, sent, number);
  receive(back, received, number);
  return monotonic_ns() - start_ns;
}

void run(const Arguments & arguments) {
  const size_t bytes = arguments.number("bytes");
  const size_t warm_up = arguments.number("warm_up");
  std::vector<int64_t> samples_ns(warm_up + arguments.number("iterations"));
  Slot & there = Slot::create(bytes);
  Slot & back = Slot::create(bytes);
  const pid_t child =
    fork_on(arguments.number("cpu_2"), [&] { pong(there, back, bytes, samples_ns.size()); });
  pin_to(arguments.number("cpu_1"));
  const Payload sent(bytes);
  Payload received(bytes);
  for (uint32_t i = 0; i < samples_ns.size(); ++i) {
    samples_ns[i] = round_trip(there, back, sent, received, i + 1);
  }
  waitpid(child, nullptr, 0);
  drop_warm_up(samples_ns, warm_up);
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
