// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Slot of process `pid`. Throws Error{invalid_argument} if it is not on the platform.
uint32_t process_of(Registry & registry, pid_t pid);

/// Counts `size_bytes` that process `pid` shares with its workers as SMEM of its cluster, replacing
/// its former charge. The charge ends with the process, however that ends. Throws Error{no_space},
/// leaving the former charge, and Error{invalid_argument} if the process is not on the platform.
void charge_smem(Registry & registry, pid_t pid, uint64_t size_bytes);

/// Ends the charge of a leaving or dead process. The caller holds the registry lock.
void discharge(Registry & registry, uint32_t process) noexcept;

}  // namespace manycore
