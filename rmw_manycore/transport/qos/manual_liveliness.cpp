// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/qos/manual_liveliness.hpp"

#include "virtual_time/door.hpp"

namespace manycore {

bool ManualLiveliness::ran_out(int64_t asserted_ns) const noexcept {
  return asserted_ns != never && qos_now_ns() - asserted_ns >= lease_ns_;
}

bool ManualLiveliness::assert_now() noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  const int64_t before_ns = asserted_ns_.load(std::memory_order_relaxed);
  lost_ += ran_out(before_ns) ? 1 : 0;
  // seq_cst, before the caller loads the watchers: a waiting thread registers before it loads this.
  asserted_ns_.store(qos_now_ns(), std::memory_order_seq_cst);
  // The clock is read again: a thread that looked just before the store may have found that the
  // lease had run out by then, and has to learn that it has not.
  return before_ns == never || ran_out(before_ns);
}

TimedCount ManualLiveliness::lost() const noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  const int64_t asserted_ns = asserted_ns_.load(std::memory_order_relaxed);
  if (ran_out(asserted_ns)) {
    return {lost_ + 1, infinite_ns};
  }
  const bool running = asserted_ns != never && lease_ns_ <= infinite_ns - asserted_ns;
  return {lost_, running ? asserted_ns + lease_ns_ : infinite_ns};
}

}  // namespace manycore
