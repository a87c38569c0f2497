// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "rmw/serialization/cdr.hpp"
#include "transport/process.hpp"
#include "transport/subscription/claim.hpp"

namespace rmw_manycore {

/// Deserializes a claimed record. An adopted message leaves its large sequences in the record if
/// the record can be held. The first time that held memory is at a limit, so that all is copied,
/// this logs a warning and sets `has_warned`. Throws as Cdr::deserialize().
void read(
  manycore::Claim & claim, const Cdr & cdr, void * message,
  const std::shared_ptr<manycore::Process> & process, std::atomic<bool> & has_warned);

}  // namespace rmw_manycore
