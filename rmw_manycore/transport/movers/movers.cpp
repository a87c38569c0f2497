// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/movers/movers.hpp"

#include <pthread.h>
#include <unistd.h>

#include <cstdio>
#include <thread>
#include <utility>

#include "transport/transfer/transfer_pipes.hpp"

namespace manycore {
namespace {

/// A mover that cannot go on takes the receive thread with it, and a successor starts both.
template<typename Mover>
void start_thread(std::unique_ptr<Mover> mover, const char * name) {
  if (mover == nullptr) {
    return;
  }
  std::thread thread([mover = std::move(mover)] {
    try {
      mover->run();
    } catch (const std::exception & error) {
      std::fprintf(stderr, "[manycore_receive_thread] %s\n", error.what());
      _exit(1);
    }
  });
  pthread_setname_np(thread.native_handle(), name);
  thread.detach();
}

}  // namespace

Movers::Movers(Registry & registry, uint32_t cluster) {
  if (!transfer_pipes::priorities(registry).empty()) {
    packets_ = std::make_unique<PacketMover>(registry, cluster);
  }
  if (transfer_pipes::has_sessions(registry)) {
    copies_ = std::make_unique<CopyMover>(registry, cluster);
  }
}

void Movers::start() {
  start_thread(std::move(packets_), "manycore_data");
  start_thread(std::move(copies_), "manycore_uc");
}

}  // namespace manycore
