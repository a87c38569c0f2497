// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

namespace manycore {

/// Keeps a thread's phase odd during its lifetime. The thread may then follow references into
/// memory that another process frees only after it has seen the phase even or changed. See
/// docs/design/rows_seats_hands.md.
class OddPhase {
public:
  /// A phase left odd by a dead predecessor stays odd. seq_cst: Dekker with the process that frees,
  /// which removes the references before it loads the phase.
  static void begin(std::atomic<uint64_t> & phase) noexcept {
    phase.store(phase.load(std::memory_order_relaxed) | 1, std::memory_order_seq_cst);
  }
  /// Release: all reads through the references happen before this store.
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
