// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

/// While it lives, the phase of its thread is odd: the thread may follow references into memory
/// that others free only when they saw the phase change. See docs/design/topic_dsm.md, Freeing.
class OddPhase {
public:
  /// A phase that a dead predecessor left odd stays so. seq_cst: Dekker with the one that frees,
  /// which removes the references before it looks at the phase.
  static void begin(std::atomic<uint64_t> & phase) noexcept {
    phase.store(phase.load(std::memory_order_relaxed) | 1, std::memory_order_seq_cst);
  }
  /// Release: what was read through the references was read before.
  static void end(std::atomic<uint64_t> & phase) noexcept {
    phase.store(phase.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  explicit OddPhase(std::atomic<uint64_t> & phase) noexcept : phase_(phase) { begin(phase_); }
  OddPhase(const OddPhase &) = delete;
  OddPhase & operator=(const OddPhase &) = delete;
  ~OddPhase() { end(phase_); }

private:
  std::atomic<uint64_t> & phase_;
};

}  // namespace manycore
