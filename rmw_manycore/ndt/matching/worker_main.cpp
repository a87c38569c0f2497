// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// manycore_ndt_worker SESSION INDEX HOST_CPU PARENT: a worker process, started and ended by its
// coordinator, the process PARENT.

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "ndt/matching/worker.hpp"
#include "platform/child_process.hpp"
#include "platform/os_process.hpp"

int main(int argc, char ** argv) {
  if (argc != 5) {
    std::fputs("manycore_ndt_worker is started by the scan matcher, not by hand\n", stderr);
    return 2;
  }
  try {
    manycore::pin_to_cpu(std::atoi(argv[3]));
    manycore::end_with_parent(std::atoi(argv[4]));
    const auto index = static_cast<uint32_t>(std::atoi(argv[2]));
    manycore::ndt::Worker(manycore::SharedMemory::attach(argv[1]), index).run();
  } catch (const std::exception & error) {
    std::fprintf(stderr, "manycore_ndt_worker: %s\n", error.what());
    return 1;
  }
}
