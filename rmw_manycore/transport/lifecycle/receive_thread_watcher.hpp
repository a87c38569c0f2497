// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <thread>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Keeps the own cluster's receive thread alive: starts it where it is missing, sleeps on its
/// pidfd, and starts it again when it died. One thread that is never due, so it costs no CPU.
class ReceiveThreadWatcher {
public:
  ReceiveThreadWatcher(Registry & registry, uint32_t cluster);
  ~ReceiveThreadWatcher();
  ReceiveThreadWatcher(const ReceiveThreadWatcher &) = delete;
  ReceiveThreadWatcher & operator=(const ReceiveThreadWatcher &) = delete;

private:
  void run();
  /// False when nothing is left to watch.
  bool watch_once();
  bool is_cut_off();

  Registry & registry_;
  uint32_t cluster_;
  std::thread thread_;
};

}  // namespace manycore
