// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "transport/movers/arrivals.hpp"

namespace manycore {

/// The UC of a cluster: moves records between the buffers of sessions that publishers of this
/// cluster have with others (transfer: session). The owner's thread runs it.
class CopyMover {
public:
  CopyMover(Registry & registry, uint32_t cluster);

  /// Runs until the process ends. Throws Error{system} when the pipe cannot be read.
  void run();

private:
  static constexpr size_t batch_size = 16;

  size_t receive(size_t max_count);
  void handle(const CopyRequest & request) noexcept;
  /// False when the record was overwritten before it was copied, or meanwhile.
  bool copy(const CopyRequest & request, const Destination & to) const noexcept;
  void recover();

  Registry & registry_;
  const Cluster & cluster_;
  std::atomic<uint64_t> & phase_;
  Pipe requests_;
  std::vector<CopyRequest> batch_;
};

}  // namespace manycore
