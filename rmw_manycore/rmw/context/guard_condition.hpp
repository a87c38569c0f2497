// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "rmw/types.h"
#include "transport/process.hpp"

namespace rmw_manycore {

/// A condition that wait sets can wait for: a trigger by the program, or a change of the graph.
/// Keeps the platform joined, so it may be triggered at any time. Thread-safe.
class GuardCondition {
public:
  enum class Source { trigger, graph };

  GuardCondition(rmw_context_t & context, Source source);
  GuardCondition(const GuardCondition &) = delete;
  GuardCondition & operator=(const GuardCondition &) = delete;

  rmw_guard_condition_t handle{};

  Source source() const noexcept { return source_; }
  manycore::Waiters & waiters() const noexcept { return process_->waiters(); }
  manycore::Watchers & watchers() noexcept { return watchers_; }
  void trigger() noexcept;
  bool ready() const noexcept;
  /// As ready(), and resets the condition: the next wait needs a new trigger or change.
  bool take() noexcept;

private:
  const std::shared_ptr<manycore::Process> process_;
  const Source source_;
  manycore::Watchers watchers_{};
  const manycore::Watched watched_;
  std::atomic<bool> triggered_{false};
  std::atomic<uint64_t> seen_generation_;  ///< graph generation at the last take()
};

}  // namespace rmw_manycore
