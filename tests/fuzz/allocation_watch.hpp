// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// How much memory was asked for at once, by any library of this process, as the address sanitizer
/// sees it. More than 16 MiB at once is not to be had.
namespace allocation_watch {

/// Throws std::runtime_error where the sanitizer takes no hooks.
void start();
/// In bytes, since the last call.
size_t largest() noexcept;

}  // namespace allocation_watch
