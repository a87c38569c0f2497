// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// manycore_timekeeper PLATFORM FACTOR: keeps the virtual time of a run. Started by `manycore run`,
// which tells it over standard input what it starts, and reads what it reports.

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "platform/shared_memory.hpp"
#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {
namespace {

void keep(const std::string & platform, double factor) {
  const SharedMemory memory = SharedMemory::anonymous("virtual_time", sizeof(virtual_time::Page));
  auto * const page = new (memory.data()) virtual_time::Page{};
  page->magic = virtual_time::page_magic;
  page->now_ns.store(virtual_time::start_ns);
  page->timekeeper = getpid();
  page->factor = factor;
  Registry registry(PlatformPaths::of(platform));
  std::printf("page %s\n", memory.shared_path().c_str());
  std::fflush(stdout);
  Timekeeper(registry, *page).run();
}

}  // namespace
}  // namespace manycore

int main(int argc, char ** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: manycore_timekeeper PLATFORM FACTOR\n");
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  try {
    manycore::keep(argv[1], std::atof(argv[2]));
    return 0;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "[manycore_timekeeper] %s\n", error.what());
    return 1;
  }
}
