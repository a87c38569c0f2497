// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// Ends every program: one line of JSON on standard output, as the Python side reads it.
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

/// Tells the orchestrator that the program has done its part of the set-up.
inline void announce_ready() {
  std::printf("ready\n");
  std::fflush(stdout);
}

/// Returns when the orchestrator closes our standard input.
inline void wait_for_end_of_input() {
  while (std::getchar() != EOF) {
  }
}

/// Calls `body(arguments)`; an exception becomes a line on standard error and a failure.
template<typename Body>
int run_program(int argc, char ** argv, Body body) {
  try {
    body(Arguments(argc, argv));
    return EXIT_SUCCESS;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return EXIT_FAILURE;
  }
}

}  // namespace manycore::bench
