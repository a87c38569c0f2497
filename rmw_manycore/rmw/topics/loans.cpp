// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/topics/loans.hpp"

#include <algorithm>

namespace rmw_manycore {

// operator new[] aligns for all fundamental types, and plain types contain nothing else.

Loans::Messages::const_iterator Loans::find(const void * message) const {
  return std::find_if(
    lent_.begin(), lent_.end(), [&](const Message & lent) { return lent.get() == message; });
}

void * Loans::lend() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) {
    free_.emplace_back(new std::byte[message_bytes_]);
  }
  lent_.push_back(std::move(free_.back()));
  free_.pop_back();
  return lent_.back().get();
}

bool Loans::is_lent(const void * message) const {
  const std::lock_guard lock(mutex_);
  return find(message) != lent_.end();
}

bool Loans::give_back(const void * message) {
  const std::lock_guard lock(mutex_);
  const auto found = lent_.begin() + (find(message) - lent_.cbegin());
  if (found == lent_.end()) {
    return false;
  }
  free_.push_back(std::move(*found));
  lent_.erase(found);
  return true;
}

}  // namespace rmw_manycore
