// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "transport/layout/endpoint.hpp"

namespace manycore::python {

/// "RIHS01_" and 64 hexadecimal digits (REP 2011).
std::string to_text(const TypeHash & hash);

/// Raises ValueError in Python if `text` is not a type hash.
TypeHash type_hash_from(const std::string & text);

}  // namespace manycore::python
