// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace rmw_manycore {

/// Implementation identifier in each handle. Compared by address, as rmw's own checks do.
extern const char * const identifier;

}  // namespace rmw_manycore
