// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rmw/serialization/length_plan.hpp"

namespace rmw_manycore {

/// A message's CDR whose large sequences of numbers are cut to a few elements. The type support
/// reads it as any other message, but copies little.
struct CutCdr {
  struct Sequence {
    const NumberSequence * field;  ///< of the plan
    size_t at;                     ///< position of the elements in the whole CDR
    size_t count;
  };

  std::vector<uint8_t> bytes;       ///< empty if nothing was cut
  std::vector<Sequence> sequences;  ///< those that were cut, in the order of the CDR

  /// `cdr` has an encapsulation header, this machine's byte order and no fault. Cuts sequences with
  /// elements of `min_bytes` (at least 16) together.
  static CutCdr of(const LengthPlan & plan, const uint8_t * cdr, size_t size, size_t min_bytes);
};

}  // namespace rmw_manycore
