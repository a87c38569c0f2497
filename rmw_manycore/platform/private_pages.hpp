// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace manycore {

/// Replaces the pages that contain a range of shared memory by private copies at the same
/// addresses. Async-signal-safe. False if there is no memory; the pages are then as before.
bool make_pages_private(const void * data, size_t size_bytes) noexcept;

}  // namespace manycore
