// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/movers/arrivals.hpp"

namespace manycore {

/// Puts packets of a cluster's data pipes together in landings (transfer: message). Those of the
/// highest priority are received first. The owner's thread runs it.
class PacketMover {
public:
  PacketMover(Registry & registry, uint32_t cluster);

  /// Runs until the process ends. Throws Error{system} when the pipes cannot be read.
  void run();

private:
  static constexpr size_t batch_size = 16;

  size_t receive(const Pipe & pipe, size_t max_count);
  void handle(const Packet & packet) noexcept;
  /// False when packets before it are missing.
  bool append(const Packet & packet, const Destination & to) const noexcept;
  /// Handles what a killed predecessor left in the pipes, then gives up the records that it had
  /// received in part.
  void recover();

  Registry & registry_;
  const Cluster & cluster_;
  std::atomic<uint64_t> & phase_;
  std::vector<Pipe> pipes_;  ///< the highest priority first
  std::vector<Packet> batch_;
};

}  // namespace manycore
