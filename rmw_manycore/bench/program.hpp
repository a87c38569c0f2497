// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "bench/arguments.hpp"

namespace manycore::bench {

using Counts = std::map<std::string, uint64_t>;

/// Removes the first `count` samples.
inline void drop_warm_up(std::vector<int64_t> & samples_ns, size_t count) {
  samples_ns.erase(samples_ns.begin(), samples_ns.begin() + static_cast<ptrdiff_t>(count));
}

/// Prints the result of a program: one line of JSON on standard output, parsed by the Python side.
inline void print_samples(const std::vector<int64_t> & samples_ns, const Counts & counts = {}) {
  std::printf("{");
  for (const auto & [name, count] : counts) {
    std::printf("\"%s\": %llu, ", name.c_str(), static_cast<unsigned long long>(count));
  }
  std::printf("\"samples_ns\": [");
  for (size_t i = 0; i < samples_ns.size(); ++i) {
    std::printf("%s%lld", i == 0 ? "" : ",", static_cast<long long>(samples_ns[i]));
  }
  std::printf("]}\n");
  std::fflush(stdout);
}

/// Reports to the orchestrator that the program has completed its set-up.
inline void announce_ready() {
  std::printf("ready\n");
  std::fflush(stdout);
}

/// Returns when the orchestrator closes this program's standard input.
inline void wait_for_end_of_input() {
  while (std::getchar() != EOF) {
  }
}

/// The kernel kills this program when its parent dies, which must be process `parent`.
inline void die_with(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {
    std::exit(EXIT_FAILURE);  // it died before the call
  }
}

/// Calls `body(arguments)`. An exception is printed to standard error and becomes a failure status.
template<typename Body>
int run_program(int argc, char ** argv, Body body) {
  try {
    const Arguments arguments(argc, argv);
    die_with(static_cast<pid_t>(arguments.number("parent")));
    body(arguments);
    return EXIT_SUCCESS;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return EXIT_FAILURE;
  }
}

}  // namespace manycore::bench
