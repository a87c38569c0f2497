// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace manycore {

/// How much of its ring a publisher has used at most, over a number of messages: whether a smaller
/// one would do. The number doubles when a smaller one did not do for long, so bursts that come
/// back make the ring change its size a few times and then no more.
class Demand {
public:
  /// After a record was placed: what the ring holds.
  void note(uint64_t records, uint64_t bytes) noexcept {
    records_ = std::max(records_, records);
    bytes_ = std::max(bytes_, bytes);
    ++messages_;
  }
  bool is_known() const noexcept { return messages_ >= patience_; }
  uint64_t records() const noexcept { return records_; }
  uint64_t bytes() const noexcept { return bytes_; }

  void start_over() noexcept { records_ = bytes_ = messages_ = 0; }
  void note_shrunk() noexcept { has_shrunk_ = true; }
  void note_grown() noexcept {
    patience_ = has_shrunk_ ? std::min(patience_ * 2, most_patience) : patience_;
    has_shrunk_ = false;
    start_over();
  }

private:
  static constexpr uint64_t least_patience = 1024;  ///< messages
  static constexpr uint64_t most_patience = 64 * least_patience;

  uint64_t records_ = 0;
  uint64_t bytes_ = 0;
  uint64_t messages_ = 0;
  uint64_t patience_ = least_patience;
  bool has_shrunk_ = false;  ///< since it grew last
};

}  // namespace manycore
