// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rmw/serialization/cdr.hpp"
#include "transport/process.hpp"
#include "transport/subscription/claim.hpp"

namespace rmw_manycore {

/// Deserializes a claimed record. An adopted message leaves its large sequences in the record if
/// the record can be held. Throws as Cdr::deserialize().
void read(
  manycore::Claim & claim, const Cdr & cdr, void * message,
  const std::shared_ptr<manycore::Process> & process);

}  // namespace rmw_manycore
