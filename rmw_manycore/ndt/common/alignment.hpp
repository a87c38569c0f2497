// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace manycore::ndt {

/// The next multiple of a cache line's 64 bytes.
constexpr uint64_t align_up(uint64_t offset) noexcept { return (offset + 63) / 64 * 64; }

}  // namespace manycore::ndt
