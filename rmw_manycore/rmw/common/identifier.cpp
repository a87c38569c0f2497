// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/identifier.hpp"

#include "rmw/rmw.h"

namespace rmw_manycore {

const char * const identifier = "rmw_manycore";

}  // namespace rmw_manycore

const char * rmw_get_implementation_identifier() { return rmw_manycore::identifier; }

const char * rmw_get_serialization_format() { return "cdr"; }
