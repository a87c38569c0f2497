// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Slot of process `pid`. Throws Error{invalid_argument} when it is not on the platform.
uint32_t process_of(Registry & registry, pid_t pid);

/// Counts memory that process `pid` shares with its helpers as SMEM of its cluster, instead of what
/// it had counted before. Its end gives it back, however it ends. Throws Error{no_space}, with the
/// old count left, and Error{invalid_argument} when the process is not on the platform.
void charge_smem(Registry & registry, pid_t pid, uint64_t size_bytes);

/// For a process that goes; the caller holds the registry lock.
void discharge(Registry & registry, uint32_t process) noexcept;

}  // namespace manycore
