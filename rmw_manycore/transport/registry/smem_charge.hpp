// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "transport/registry/registry.hpp"

namespace manycore {

/// Slot of a process. Throws Error{invalid_argument} if it is not on the platform.
uint32_t process_of(Registry & registry, const ProcessIdentity & identity);

/// Counts `size_bytes` that a process shares with its workers as SMEM of its cluster, replacing
/// its former charge. The charge ends with the process, however that ends. Throws Error{no_space},
/// leaving the former charge, and Error{invalid_argument} if the process is not on the platform.
void charge_smem(Registry & registry, const ProcessIdentity & identity, uint64_t size_bytes);

/// Ends the charge of a leaving or dead process. The caller holds the registry lock.
void discharge(Registry & registry, uint32_t process) noexcept;

}  // namespace manycore
