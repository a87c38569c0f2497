// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How many wake words of a process are notified while this program runs?
//
//   wake_ups pid=N
//
// Counts for threads that spin, too, which no context switch shows. Prints "ready", and the count
// once its input has ended.
#include "bench/program.hpp"
#include "transport/process.hpp"
#include "transport/registry/registry.hpp"

namespace {

using namespace manycore;

/// The process's entry, which its slot keeps after its end until another process takes it.
const ProcessEntry & entry_of(Registry & registry, pid_t pid) {
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (registry.processes().is_live(slot) && registry.processes()[slot].pid == pid) {
      return registry.processes()[slot];
    }
  }
  throw std::runtime_error("process " + std::to_string(pid) + " is not on the platform");
}

/// Epochs wrap around: add them, and subtract sums, as unsigned numbers of their size.
uint32_t sum_of_epochs(const ProcessEntry & process) {
  uint32_t sum = 0;
  for (const WakeWord & word : process.wake.words) {
    sum += word.epoch.load();
  }
  return sum;
}

void run(const bench::Arguments & arguments) {
  Registry registry(PlatformPaths::of(Placement::from_environment().platform));
  const ProcessEntry & process = entry_of(registry, static_cast<pid_t>(arguments.number("pid")));
  const uint32_t before = sum_of_epochs(process);
  bench::announce_ready();
  bench::wait_for_end_of_input();
  bench::print_samples({}, {{"notified", sum_of_epochs(process) - before}});
}

}  // namespace

int main(int argc, char ** argv) { return bench::run_program(argc, argv, run); }
