// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Do messages get lost when four clusters write into the pipe of one, whose core stores them in
// DRAM?
//
//   noc_overflow flow_control=0|1 messages=N cpu_1=N cpu_2=N
//
// The writers are on the CPU cpu_1, the reader is on cpu_2. Prints how many messages were `sent`,
// `lost` (refused by the full pipe, as a notification is) and `received`. With flow control a
// writer has at most its share of the pipe under way, and sleeps until the reader has made room.
#include <array>
#include <atomic>
#include <cstring>

#include "bench/flush.hpp"
#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "bench/unnamed_pipe.hpp"
#include "platform/cpu.hpp"

namespace {

using namespace manycore::bench;

constexpr size_t writers = 4;
constexpr size_t packet_bytes = 4096;
constexpr uint32_t pipe_packets = 16;  // the least a pipe has room for: 64 KiB
constexpr uint32_t share = pipe_packets / writers;

struct Packet {
  uint32_t writer;
  bool is_last;
  std::array<std::byte, packet_bytes - 8> data;
};
static_assert(sizeof(Packet) == packet_bytes);

struct alignas(cache_line_bytes) Writer {
  manycore::FutexWord received{0};
  std::atomic<uint64_t> lost{0};
};

struct Shared {
  std::array<Writer, writers> writer;
};

void wait_for_room(Writer & writer, uint32_t delivered) {
  for (uint32_t seen = writer.received.load(); delivered - seen >= share;
       seen = writer.received.load()) {
    manycore::futex_wait(writer.received, seen, std::nullopt);
  }
}

void write(
  const manycore::Pipe & pipe, Writer & self, uint32_t number, size_t messages,
  bool is_controlled) {
  Packet packet{};
  packet.writer = number;
  uint32_t delivered = 0;
  for (size_t i = 0; i < messages; ++i) {
    if (is_controlled) {
      wait_for_room(self, delivered);
    }
    const bool was_sent = pipe.try_send(&packet, sizeof packet);
    delivered += was_sent ? 1 : 0;
    self.lost += was_sent ? 0 : 1;
  }
  packet.is_last = true;  // not counted
  while (!pipe.try_send(&packet, sizeof packet)) {
    manycore::yield_cpu();
  }
}

uint64_t read_all(const manycore::Pipe & pipe, Shared & shared, std::byte * memory) {
  uint64_t received = 0;
  Packet packet{};
  for (size_t open = writers; open > 0;) {
    if (pipe.receive(&packet, sizeof packet) != sizeof packet) {
      continue;
    }
    if (packet.is_last) {
      --open;
      continue;
    }
    std::memcpy(memory, packet.data.data(), packet.data.size());
    flush(memory, packet.data.size());
    ++received;
    Writer & writer = shared.writer[packet.writer];
    ++writer.received;
    manycore::futex_wake_all(writer.received);
  }
  return received;
}

void run(const Arguments & arguments) {
  const size_t messages = arguments.number("messages");
  const bool is_controlled = arguments.number("flow_control") != 0;
  Shared & shared = *new (shared_memory(sizeof(Shared))) Shared;
  const manycore::Pipe pipe = open_unnamed_pipe();
  for (uint32_t number = 0; number < writers; ++number) {
    fork_on(arguments.number("cpu_1"), [&] {
      write(pipe, shared.writer[number], number, messages, is_controlled);
    });
  }
  pin_to(arguments.number("cpu_2"));
  const uint64_t received = read_all(pipe, shared, shared_memory(packet_bytes));
  wait_for_children();
  uint64_t lost = 0;
  for (const Writer & writer : shared.writer) {
    lost += writer.lost;
  }
  print_samples({}, {{"sent", writers * messages}, {"lost", lost}, {"received", received}});
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
