// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long does data take from a memory of one cluster to the memory of another?
//
//   noc_transfer method=tx|uc|message memory=smem|ddr bytes=N cpu_1=N cpu_2=N cpu_uc=N
//     warm_up=N iterations=N
//
// From the sender's start to the receiver's waking up with the data in its own memory.
//   tx       the sender's core copies into the receiver's segment and wakes it
//   uc       the sender has another process copy, on the CPU cpu_uc, which then wakes the receiver
//   message  packets through a pipe; the receiver's core copies them out (an eMCOS message)
// smem: the sender has just touched its data; ddr: the data was flushed from all caches before.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "bench/flush.hpp"
#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "bench/unnamed_pipe.hpp"
#include "platform/clock.hpp"
#include "platform/cpu.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr size_t packet_bytes = 4096;  // PIPE_BUF

/// What all processes share; made before they are forked.
struct Parties {
  explicit Parties(size_t size_bytes)
  : bytes(size_bytes),
    source(shared_memory(size_bytes)),
    destination(Slot::create(size_bytes)),
    order(Slot::create(0)),
    answer(Slot::create(sizeof(int64_t))),
    pipe(open_unnamed_pipe()) {}

  size_t bytes;
  std::byte * source;
  Slot & destination;  ///< in the receiver's cluster
  Slot & order;        ///< to the UC
  Slot & answer;       ///< when the receiver woke up
  manycore::Pipe pipe;
};

void copy(Parties & parties, uint32_t number) {
  std::memcpy(parties.destination.payload(), parties.source, parties.bytes);
  parties.destination.announce(number);
}

void send_packets(const Parties & parties) {
  std::array<std::byte, packet_bytes> packet{};
  for (size_t sent = 0; sent < parties.bytes; sent += packet_bytes) {
    std::memcpy(packet.data(), parties.source + sent, std::min(packet_bytes, parties.bytes - sent));
    while (!parties.pipe.try_send(packet.data(), packet.size())) {
      manycore::yield_cpu();
    }
  }
}

void receive_packets(const Parties & parties) {
  std::array<std::byte, packet_bytes> packet{};
  for (size_t got = 0; got < parties.bytes;) {
    if (parties.pipe.receive(packet.data(), packet.size()) == packet.size()) {
      const size_t part = std::min(packet_bytes, parties.bytes - got);
      std::memcpy(parties.destination.payload() + got, packet.data(), part);
      got += part;
    }
  }
}

void receive(Parties & parties, bool by_message, size_t messages) {
  for (uint32_t number = 1; number <= messages; ++number) {
    if (by_message) {
      receive_packets(parties);
    } else {
      parties.destination.wait_for(number);
    }
    const int64_t woken_ns = monotonic_ns();
    std::memcpy(parties.answer.payload(), &woken_ns, sizeof woken_ns);
    parties.answer.announce(number);
  }
}

void be_uc(Parties & parties, size_t messages) {
  for (uint32_t number = 1; number <= messages; ++number) {
    parties.order.wait_for(number);
    copy(parties, number);
  }
}

void prepare(Parties & parties, bool in_ddr, uint32_t number) {
  std::memset(parties.source, static_cast<int>(number & 0xFF), parties.bytes);
  if (in_ddr) {
    flush(parties.source, parties.bytes);
  }
}

int64_t transfer(Parties & parties, const std::string & method, uint32_t number) {
  const int64_t start_ns = monotonic_ns();
  if (method == "tx") {
    copy(parties, number);
  } else if (method == "uc") {
    parties.order.announce(number);
  } else {
    send_packets(parties);
  }
  parties.answer.wait_for(number);
  int64_t woken_ns = 0;
  std::memcpy(&woken_ns, parties.answer.payload(), sizeof woken_ns);
  return woken_ns - start_ns;
}

void check(const Parties & parties, uint32_t number) {
  const auto expected = static_cast<std::byte>(number & 0xFF);
  const std::byte * const data = parties.destination.payload();
  if (!std::all_of(data, data + parties.bytes, [&](std::byte b) { return b == expected; })) {
    throw std::runtime_error("the receiver has other data than the sender");
  }
}

void run(const Arguments & arguments) {
  const std::string & method = arguments.text("method");
  const bool in_ddr = arguments.text("memory") == "ddr";
  const size_t warm_up = arguments.number("warm_up");
  std::vector<int64_t> samples_ns(warm_up + arguments.number("iterations"));
  const size_t messages = samples_ns.size();
  if (arguments.number("bytes") == 0 || (method != "tx" && method != "uc" && method != "message")) {
    throw std::invalid_argument("expected bytes > 0 and method=tx, uc or message");
  }
  Parties parties(arguments.number("bytes"));
  fork_on(arguments.number("cpu_2"), [&] { receive(parties, method == "message", messages); });
  if (method == "uc") {
    fork_on(arguments.number("cpu_uc"), [&] { be_uc(parties, messages); });
  }
  pin_to(arguments.number("cpu_1"));
  for (uint32_t i = 0; i < messages; ++i) {
    prepare(parties, in_ddr, i + 1);
    samples_ns[i] = transfer(parties, method, i + 1);
    check(parties, i + 1);
  }
  wait_for_children();
  drop_warm_up(samples_ns, warm_up);
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
