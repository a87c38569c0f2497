// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What would a round trip between clusters cost on the bare machine? Peer of rmw_manycore between
// clusters.
//
//   relay_round_trip cpu_1=N cpu_2=N bytes=N warm_up=N iterations=N
//
// Two processes, each with a relay. The sender copies the payload into shared memory and writes 64
// bytes to the pipe of the receiver's relay; the relay wakes the receiver, which copies the payload
// out. A relay runs on the CPU of the process that it wakes, like a receive thread here.
#include <array>
#include <cstring>

#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

using Payload = std::vector<std::byte>;

/// Same size as an eMCOS message.
struct Notice {
  uint32_t number;
  std::array<std::byte, 60> rest;
};
static_assert(sizeof(Notice) == 64);

/// One direction: slot, pipe, and the relay between them.
class Direction {
public:
  explicit Direction(size_t bytes) : slot_(Slot::create(bytes)) {
    if (pipe(pipe_) != 0) {
      throw std::system_error(errno, std::generic_category(), "pipe");
    }
  }

  void send(const Payload & payload, uint32_t number) {
    std::memcpy(slot_.payload(), payload.data(), payload.size());
    const Notice notice{number, {}};
    if (write(pipe_[1], &notice, sizeof notice) != sizeof notice) {
      throw std::system_error(errno, std::generic_category(), "write");
    }
  }

  void receive(Payload & payload, uint32_t number) {
    slot_.wait_for(number);
    std::memcpy(payload.data(), slot_.payload(), payload.size());
  }

  void relay(size_t messages) {
    Notice notice{};
    for (size_t i = 0; i < messages && read(pipe_[0], &notice, sizeof notice) > 0; ++i) {
      slot_.announce(notice.number);
    }
  }

private:
  Slot & slot_;
  int pipe_[2];
};

void pong(Direction & there, Direction & back, size_t bytes, size_t messages) {
  Payload payload(bytes);
  for (uint32_t number = 1; number <= messages; ++number) {
    there.receive(payload, number);
    back.send(payload, number);
  }
}

int64_t round_trip(
  Direction & there, Direction & back, const Payload & sent, Payload & received, uint32_t number) {
  const int64_t start_ns = monotonic_ns();
  there.send(sent, number);
  back.receive(received, number);
  return monotonic_ns() - start_ns;
}

void run(const Arguments & arguments) {
  const size_t bytes = arguments.number("bytes");
  const size_t warm_up = arguments.number("warm_up");
  const size_t cpu_1 = arguments.number("cpu_1");
  const size_t cpu_2 = arguments.number("cpu_2");
  std::vector<int64_t> samples_ns(warm_up + arguments.number("iterations"));
  Direction there(bytes);
  Direction back(bytes);
  const size_t messages = samples_ns.size();
  fork_on(cpu_1, [&] { back.relay(messages); });
  fork_on(cpu_2, [&] { there.relay(messages); });
  fork_on(cpu_2, [&] { pong(there, back, bytes, messages); });
  pin_to(cpu_1);
  const Payload sent(bytes);
  Payload received(bytes);
  for (uint32_t i = 0; i < messages; ++i) {
    samples_ns[i] = round_trip(there, back, sent, received, i + 1);
  }
  wait_for_children();
  drop_warm_up(samples_ns, warm_up);
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
