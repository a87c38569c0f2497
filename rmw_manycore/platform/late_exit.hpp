// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace manycore {

/// Ends this process with an exit status after some time, if it has not ended by then, whatever its
/// threads wait for or hold: what runs at a regular exit does not run. Throws std::system_error.
void exit_after(std::chrono::nanoseconds delay, int status);

}  // namespace manycore
