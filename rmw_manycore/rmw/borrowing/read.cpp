// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/borrowing/read.hpp"

#include <optional>
#include <utility>

#include "rmw/borrowing/adopted.hpp"

namespace rmw_manycore {
namespace {

/// False if everything has to be copied.
bool borrow(
  manycore::Claim & claim, const Cdr & cdr, void * message,
  const std::shared_ptr<manycore::Process> & process, Borrowed & borrowed) {
  const CutCdr cut = cdr.cut(claim.data(), claim.size(), min_borrowed_bytes);
  if (cut.sequences.empty()) {
    return false;
  }
  Borrowed found;
  found.paths.reserve(cut.sequences.size());
  found.sequences.reserve(cut.sequences.size());
  std::optional<manycore::Hold> hold = claim.hold();
  if (!hold) {
    return false;
  }
  // A sole holder may write into its record.
  auto * const record = const_cast<uint8_t *>(hold->data());
  for (const CutCdr::Sequence & sequence : cut.sequences) {
    found.paths.push_back(sequence.field->path);
    found.sequences.push_back({found.paths.back().c_str(), record + sequence.at, sequence.count});
  }
  found.hold.reset(new RecordHold{process, std::move(*hold)});
  cdr.deserialize(cut.bytes.data(), cut.bytes.size(), message);
  if (found.hold->hold.is_sole()) {  // else Python's message gets a copy
    claim.count_in_place();
  }
  borrowed = std::move(found);
  return true;
}

}  // namespace

void read(
  manycore::Claim & claim, const Cdr & cdr, void * message,
  const std::shared_ptr<manycore::Process> & process) {
  Borrowed * const borrowed = Adopted::messages().find(message);
  if (borrowed != nullptr) {
    *borrowed = {};  // of a message that was taken into it before
    if (claim.size() >= min_borrowed_bytes && borrow(claim, cdr, message, process, *borrowed)) {
      return;
    }
  }
  cdr.deserialize(claim.data(), claim.size(), message);
}

}  // namespace rmw_manycore
