// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace manycore {

/// Peak usage of a publisher's ring over a window of messages; shows whether a smaller ring would
/// do. The window doubles when the ring had to grow again after shrinking, so recurring bursts
/// resize the ring a few times and then no more.
class Demand {
public:
  /// Records what the ring holds after a record was placed.
  void note(uint64_t records, uint64_t bytes) noexcept {
    records_ = std::max(records_, records);
    bytes_ = std::max(bytes_, bytes);
    ++messages_;
  }
  bool is_known() const noexcept { return messages_ >= window_; }
  uint64_t records() const noexcept { return records_; }
  uint64_t bytes() const noexcept { return bytes_; }

  void start_over() noexcept { records_ = bytes_ = messages_ = 0; }
  void note_shrunk() noexcept { has_shrunk_ = true; }
  void note_grown() noexcept {
    window_ = has_shrunk_ ? std::min(window_ * 2, max_window) : window_;
    has_shrunk_ = false;
    start_over();
  }

private:
  static constexpr uint64_t min_window = 1024;  ///< messages in the first window
  static constexpr uint64_t max_window = 64 * min_window;

  uint64_t records_ = 0;
  uint64_t bytes_ = 0;
  uint64_t messages_ = 0;
  uint64_t window_ = min_window;
  bool has_shrunk_ = false;  ///< since it last grew
};

}  // namespace manycore
