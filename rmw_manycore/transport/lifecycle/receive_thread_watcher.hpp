// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Keeps the receive thread of the own cluster running: starts it if it is missing, waits on its
/// pidfd, and restarts it when it dies. The thread blocks all the time, so it costs no CPU.
class ReceiveThreadWatcher {
public:
  ReceiveThreadWatcher(Registry & registry, uint32_t cluster);
  ~ReceiveThreadWatcher();
  ReceiveThreadWatcher(const ReceiveThreadWatcher &) = delete;
  ReceiveThreadWatcher & operator=(const ReceiveThreadWatcher &) = delete;

private:
  void run();
  /// False if there is nothing left to watch.
  bool watch_once();
  bool is_cut_off();

  Registry & registry_;
  uint32_t cluster_;
  std::thread thread_;
};

}  // namespace manycore
