// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "transport/publisher/writing.hpp"

namespace manycore {

/// Room for one message in the topic DSM, between allocation and publication. Blocks every other
/// publish of this publisher; destroying it unpublished sends nothing. Must stay in one thread.
class Draft {
public:
  Draft(Draft && other) noexcept = default;
  Draft & operator=(Draft &&) = delete;
  ~Draft();

  uint8_t * data() const noexcept { return data_; }
  size_t capacity() const noexcept { return capacity_bytes_; }

private:
  friend class Publisher;
  Draft(Writing && writing, TopicDsmWriter & writer, size_t size_bytes);

  Writing writing_;
  TopicDsmWriter & writer_;
  uint8_t * data_ = nullptr;
  size_t capacity_bytes_ = 0;
};

}  // namespace manycore
