// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/rcl_node.hpp"
#include "bench/reference/interruption.hpp"
#include "bench/reference/kinds.hpp"

namespace manycore::bench::reference {

/// Calls the callbacks of `kind` in this thread, one at a time, until an interruption.
void spin(RclContext & context, const RclNode & node, Kind & kind, const Interruption & end);

}  // namespace manycore::bench::reference
