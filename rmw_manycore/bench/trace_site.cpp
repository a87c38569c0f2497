// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// What does a trace site cost, and how many events are recorded without loss?
//
//   trace_site events=N rounds=N
//
// Prints picoseconds of thread CPU time per event: of a site while tracing is off, minus an empty
// loop (`samples_ns`, the name common to all programs), and while tracing is on (`on_ps`); and how
// many of the events of all rounds were lost.
#include <algorithm>

#include "bench/program.hpp"
#include "platform/clock.hpp"
#include "transport/lifecycle/trace_control.hpp"
#include "transport/lifecycle/trace_saver.hpp"
#include "transport/process.hpp"

namespace {

using namespace manycore;

constexpr int64_t ps_per_ns = 1000;

/// Keeps the compiler from optimizing the loop away or hoisting loads of the site out of it.
void barrier() noexcept { asm volatile("" ::: "memory"); }

template<typename Body>
int64_t ps_for_each(uint64_t events, Body body) {
  const int64_t start_ns = clock_ns(CLOCK_THREAD_CPUTIME_ID);
  for (uint64_t i = 0; i < events; ++i) {
    body(i);
    barrier();
  }
  return (clock_ns(CLOCK_THREAD_CPUTIME_ID) - start_ns) * ps_per_ns / static_cast<int64_t>(events);
}

void run(const bench::Arguments & arguments) {
  const uint64_t events = arguments.number("events");
  const uint64_t rounds = arguments.number("rounds");
  const auto process = Process::join(Placement::from_environment());
  EndpointSpec spec;
  spec.node = process->add_node("bench", "/", "/");
  spec.topic = "/bench";
  spec.type = "std_msgs/msg/String";
  const auto publisher = process->create_publisher(spec);
  const auto slot = static_cast<uint32_t>(endpoint_in(publisher->gid()));
  Tracer & tracer = process->tracer();
  Registry registry(PlatformPaths::of(process->placement().platform));
  const auto site = [&](uint64_t i) { tracer.note(TraceKind::write, slot, i, i); };

  std::vector<int64_t> off_ps;
  for (uint64_t round = 0; round < rounds; ++round) {
    const int64_t empty_ps = ps_for_each(events, [](uint64_t) {});
    off_ps.push_back(std::max<int64_t>(ps_for_each(events, site) - empty_ps, 0));
  }
  bench::Counts counts{{"on_ps", 0}, {"lost", 0}};
  std::vector<int64_t> on_ps;
  start_trace(registry, {{}, {}, static_cast<uint32_t>(events + 1)});
  for (uint64_t round = 0; round <= rounds; ++round) {  // the first round creates the ring
    const int64_t cost_ps = ps_for_each(events, site);
    counts["lost"] += trace_state(registry).lost;
    discard_trace(registry);
    if (round != 0) {
      on_ps.push_back(cost_ps);
    }
  }
  stop_trace(registry);
  std::sort(on_ps.begin(), on_ps.end());
  counts["on_ps"] = static_cast<uint64_t>(on_ps[on_ps.size() / 2]);
  bench::print_samples(off_ps, counts);
}

}  // namespace

int main(int argc, char ** argv) { return bench::run_program(argc, argv, run); }
