// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/cut_cdr.hpp"

#include <cstring>

namespace rmw_manycore {
namespace {

/// The largest alignment in CDR: without a multiple of it, what follows stays aligned. As much is
/// kept, because a sequence without elements has no padding before them.
constexpr size_t max_alignment = 8;

constexpr size_t dropped_bytes(size_t bytes) noexcept {
  return (bytes - max_alignment) / max_alignment * max_alignment;
}

}  // namespace

CutCdr CutCdr::of(const LengthPlan & plan, const uint8_t * cdr, size_t size, size_t min_bytes) {
  CutCdr result;
  const uint8_t * copied = cdr;
  for (const LengthPlan::Found & found :
       plan.find_large(cdr + encapsulation_bytes, size - encapsulation_bytes, min_bytes)) {
    const uint8_t * const elements = cdr + encapsulation_bytes + found.at;
    const size_t bytes = found.count * found.element_bytes;
    const size_t dropped = dropped_bytes(bytes);
    result.bytes.insert(result.bytes.end(), copied, elements + (bytes - dropped));
    copied = elements + bytes;
    const auto kept = static_cast<uint32_t>((bytes - dropped) / found.element_bytes);
    const size_t length_from_end = found.at - found.length_at + (bytes - dropped);
    std::memcpy(result.bytes.data() + (result.bytes.size() - length_from_end), &kept, sizeof(kept));
    result.sequences.push_back(
      {&plan.number_sequences()[found.index], static_cast<size_t>(elements - cdr), found.count});
  }
  if (!result.sequences.empty()) {
    result.bytes.insert(result.bytes.end(), copied, cdr + size);
  }
  return result;
}

}  // namespace rmw_manycore
