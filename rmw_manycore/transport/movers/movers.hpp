// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "transport/movers/copy_mover.hpp"
#include "transport/movers/packet_mover.hpp"

namespace manycore {

/// The threads that fill landings for a cluster, where the platform has topics that need them:
/// manycore_data for messages, manycore_uc for sessions.
class Movers {
public:
  /// Opens their pipes. A pipe that no process has open forgets what is in it, so this comes before
  /// the receive thread's lifeline: a process that finds it held may hand over records and end.
  /// Throws Error{system}.
  Movers(Registry & registry, uint32_t cluster);

  /// They run on the CPU of the calling thread, a reserved core's, until the process ends.
  void start();

private:
  std::unique_ptr<PacketMover> packets_;
  std::unique_ptr<CopyMover> copies_;
};

}  // namespace manycore
