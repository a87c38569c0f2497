// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "transport/registry/registry.hpp"

/// The one match that the owner of the registry lock is changing. A match is a source, a reader,
/// and what its ends and a landing count; an owner that is killed midway leaves them in
/// disagreement. As it has noted the match before, its successor looks at that one, and not at all
/// matches of the platform. The caller holds the lock.
namespace manycore::match_in_hand {

/// Before anything of a match is changed. The changes of the match in hand until then are complete.
/// All stores of a process that dies reach other processes before the lock does: only the compiler
/// must not move any of them across the note.
inline void note(RegistryHeader & header, uint32_t publisher, uint32_t subscription) noexcept {
  std::atomic_signal_fence(std::memory_order_seq_cst);
  header.match_in_hand.publisher.store(publisher, std::memory_order_relaxed);
  header.match_in_hand.subscription.store(subscription, std::memory_order_relaxed);
  std::atomic_signal_fence(std::memory_order_seq_cst);
}

/// Undoes the match if it is made or undone by half, and counts the matches of its ends and the
/// readers of its publisher anew. May be repeated after a caller died midway. All clusters are
/// mapped.
void repair(Registry & registry);

}  // namespace manycore::match_in_hand
