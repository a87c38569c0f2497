// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// manycore_timekeeper PLATFORM FACTOR [TO_MODEL FROM_MODEL]: keeps the virtual time of a run.
// Started by `manycore run`, which names over standard input what it starts, and reads what it
// reports. The last two are file descriptors.

#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "platform/shared_memory.hpp"
#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {
namespace {

/// `model`: file descriptors of pipes to the model of the platform and from it; none: empty.
void keep(const std::string & platform, double factor, const std::vector<int> & model) {
  const SharedMemory memory = SharedMemory::anonymous("virtual_time", sizeof(virtual_time::Page));
  auto * const page = new (memory.data()) virtual_time::Page{};
  page->magic = virtual_time::page_magic;
  page->now_ns.store(virtual_time::start_ns);
  page->timekeeper = getpid();
  page->factor = factor;
  page->is_modelled = model.empty() ? 0 : 1;
  Registry registry(PlatformPaths::of(platform));
  std::printf("page %s\n", memory.shared_path().c_str());
  std::fflush(stdout);
  std::optional<PlatformModel> platform_model;
  if (!model.empty()) {
    platform_model.emplace(model.at(0), model.at(1));
  }
  Timekeeper(registry, *page, platform_model ? &*platform_model : nullptr).run();
}

}  // namespace
}  // namespace manycore

int main(int argc, char ** argv) {
  if (argc != 3 && argc != 5) {
    std::fprintf(stderr, "usage: manycore_timekeeper PLATFORM FACTOR [TO_MODEL FROM_MODEL]\n");
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGPIPE, SIG_IGN);  // a model that has ended is an error with a text
  try {
    std::vector<int> model;
    for (int i = 3; i < argc; ++i) {
      model.push_back(std::atoi(argv[i]));
    }
    manycore::keep(argv[1], std::atof(argv[2]), model);
    return 0;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "[manycore_timekeeper] %s\n", error.what());
    return 1;
  }
}
