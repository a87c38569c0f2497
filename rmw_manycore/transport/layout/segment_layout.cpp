// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/layout/segment_layout.hpp"

#include <string>

#include "platform/error.hpp"

namespace manycore {

void check_segment(
  const SegmentHeader & header, uint64_t magic, uint64_t mapped_bytes, const char * what) {
  const std::string advice = "; stop the platform's nodes and run 'manycore clean'";
  if (header.magic.load(std::memory_order_acquire) != magic) {
    throw Error(ErrorCode::corrupt, std::string(what) + " has no valid header" + advice);
  }
  if (header.version != layout_version) {
    throw Error(
      ErrorCode::corrupt, std::string(what) + " has layout version " +
                            std::to_string(header.version) + ", this library has " +
                            std::to_string(layout_version) + advice);
  }
  if (header.size_bytes != mapped_bytes) {
    throw Error(
      ErrorCode::corrupt, std::string(what) + " has " + std::to_string(mapped_bytes) +
                            " bytes, its header says " + std::to_string(header.size_bytes) +
                            advice);
  }
}

}  // namespace manycore
