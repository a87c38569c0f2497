// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "transport/layout/seat.hpp"
#include "transport/registry/registry.hpp"

namespace manycore {

/// True while the process that a word of ChunkHead::holders names is a member.
inline bool is_holding(Registry & registry, uint64_t holder) noexcept {
  const Table<ProcessEntry> & processes = registry.processes();
  const uint32_t slot = slot_in(holder);
  return holder != 0 && slot < processes.high_water() && processes.is_live(slot) &&
         processes[slot].slot.incarnation.load() == incarnation_in(holder);
}

/// Memory of one large record, and the processes that hold it.
struct HeldChunk {
  uint64_t bytes;
  std::vector<uint32_t> processes;  ///< slots, each once

  bool is_held_by(uint32_t process) const noexcept;
};

/// The chunks of a publisher that are held. For processes that follow the reference in its registry
/// entry without the registry lock: memory freed meanwhile does no harm. The result counts if the
/// entry still holds afterwards (see EntryCopy).
std::vector<HeldChunk> held_chunks(Registry & registry, const EndpointEntry & publisher);

}  // namespace manycore
