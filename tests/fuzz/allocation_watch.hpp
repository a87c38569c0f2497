// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Size of the largest single allocation by any library of this process, observed through the
/// address sanitizer. Allocations above 16 MiB fail.
namespace allocation_watch {

/// Throws std::runtime_error if the sanitizer does not support hooks.
void start();
/// In bytes, since the last call.
size_t largest() noexcept;

}  // namespace allocation_watch
