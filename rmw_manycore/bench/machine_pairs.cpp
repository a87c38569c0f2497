// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What does a cache line, or a MiB, cost between two CPUs of this machine?
//
//   machine_pairs what=line|copy cpus=A,B[,C..] bytes=N iterations=N
//
// line: each two of the CPUs pass one cache line back and forth; a sample is one way, the mean of
// all passes. copy: the first CPU writes a buffer, the second copies it; a sample is one copy.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"
#include "platform/cpu.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr uint32_t warm_up = 1000;

struct alignas(128) Line {  // two cache lines: CPUs may fetch them in pairs
  std::atomic<uint32_t> turn{0};
};

/// Answers each odd turn up to `last`.
void answer(Line & line, uint32_t last) {
  for (uint32_t turn = 1; turn < last; turn += 2) {
    while (line.turn.load(std::memory_order_acquire) != turn) {
      manycore::pause_cpu();
    }
    line.turn.store(turn + 1, std::memory_order_release);
  }
}

/// Time of one way, in ns.
int64_t pass_line(size_t cpu, size_t other, uint32_t passes) {
  Line line;
  const uint32_t last = 2 * (warm_up + passes);
  std::thread answering([&] {
    pin_to(other);
    answer(line, last);
  });
  pin_to(cpu);
  int64_t start_ns = 0;
  for (uint32_t turn = 0; turn < last; turn += 2) {
    if (turn == 2 * warm_up) {
      start_ns = monotonic_ns();
    }
    line.turn.store(turn + 1, std::memory_order_release);
    while (line.turn.load(std::memory_order_acquire) != turn + 2) {
      manycore::pause_cpu();
    }
  }
  const int64_t end_ns = monotonic_ns();
  answering.join();
  return (end_ns - start_ns) / (2 * int64_t{passes});
}

/// Each two CPUs: the first with the second, with the third .., the second with the third ..
std::vector<int64_t> lines(const std::vector<size_t> & cpus, uint32_t passes) {
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < cpus.size(); ++i) {
    for (size_t j = i + 1; j < cpus.size(); ++j) {
      samples_ns.push_back(pass_line(cpus[i], cpus[j], passes));
    }
  }
  return samples_ns;
}

/// The reading CPU's own buffer is warm; what it copies is in the caches of the writing one.
std::vector<int64_t> copies(size_t writer, size_t reader, size_t bytes, size_t iterations) {
  pin_to(reader);
  std::vector<std::byte> to(bytes);
  std::vector<std::byte> from(bytes);
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < iterations; ++i) {
    pin_to(writer);
    std::fill(from.begin(), from.end(), static_cast<std::byte>(i));
    pin_to(reader);
    const int64_t start_ns = monotonic_ns();
    std::memcpy(to.data(), from.data(), bytes);
    asm volatile("" : : "r"(to.data()) : "memory");
    samples_ns.push_back(monotonic_ns() - start_ns);
  }
  return samples_ns;
}

void run(const Arguments & arguments) {
  std::vector<size_t> cpus;
  for (const std::string & cpu : arguments.list("cpus")) {
    cpus.push_back(std::stoul(cpu));
  }
  const size_t iterations = arguments.number("iterations");
  if (arguments.text("what") == "line") {
    print_samples(lines(cpus, static_cast<uint32_t>(iterations)));
  } else {
    print_samples(copies(cpus.at(0), cpus.at(1), arguments.number("bytes"), iterations));
  }
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
