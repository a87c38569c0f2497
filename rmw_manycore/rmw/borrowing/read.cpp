// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/borrowing/read.hpp"

#include <optional>
#include <string>
#include <utility>

#include "rcutils/logging_macros.h"
#include "rmw/borrowing/adopted.hpp"
#include "rmw/common/identifier.hpp"

namespace rmw_manycore {
namespace {

bool is_read_only(manycore::ZeroCopy of_topic, bool of_program) noexcept {
  return of_topic == manycore::ZeroCopy::unset ? of_program
                                               : of_topic == manycore::ZeroCopy::read_only;
}

/// Once for each subscription.
void warn_at_limit(const manycore::Claim & claim, std::atomic<bool> & has_warned) {
  if (has_warned) {
    return;
  }
  const std::string limit = claim.reached_limit();
  if (!limit.empty() && !has_warned.exchange(true)) {
    RCUTILS_LOG_WARN_NAMED(identifier, "%s", limit.c_str());
  }
}

/// False if everything has to be copied.
bool borrow(
  manycore::Claim & claim, const Cdr & cdr, void * message,
  const std::shared_ptr<manycore::Process> & process, AdoptedMessage & adopted,
  std::atomic<bool> & has_warned) {
  const CutCdr cut = cdr.cut(claim.data(), claim.size(), min_borrowed_bytes);
  if (cut.sequences.empty()) {
    return false;
  }
  Borrowed found;
  found.paths.reserve(cut.sequences.size());
  found.sequences.reserve(cut.sequences.size());
  std::optional<manycore::Hold> hold = claim.hold();
  if (!hold) {
    warn_at_limit(claim, has_warned);
    return false;
  }
  // A sole holder may write into its record.
  auto * const record = const_cast<uint8_t *>(hold->data());
  for (const CutCdr::Sequence & sequence : cut.sequences) {
    found.paths.push_back(sequence.field->path);
    found.sequences.push_back({found.paths.back().c_str(), record + sequence.at, sequence.count});
  }
  const Access access = is_read_only(claim.zero_copy(), adopted.is_read_only) ? Access::read
                        : hold->is_sole()                                     ? Access::write
                                                                              : Access::copy;
  found.hold.reset(new RecordHold{process, std::move(*hold), access});
  cdr.deserialize(cut.bytes.data(), cut.bytes.size(), message);
  if (access != Access::copy) {
    claim.count_in_place();
  }
  adopted.borrowed = std::move(found);
  return true;
}

}  // namespace

void read(
  manycore::Claim & claim, const Cdr & cdr, void * message,
  const std::shared_ptr<manycore::Process> & process, std::atomic<bool> & has_warned) {
  AdoptedMessage * const adopted = Adopted::messages().find(message);
  if (adopted != nullptr) {
    adopted->borrowed = {};  // of a message that was taken into it before
    const bool is_large = claim.size() >= min_borrowed_bytes;
    const bool is_off = claim.zero_copy() == manycore::ZeroCopy::off;
    if (is_large && !is_off && borrow(claim, cdr, message, process, *adopted, has_warned)) {
      return;
    }
  }
  cdr.deserialize(claim.data(), claim.size(), message);
}

}  // namespace rmw_manycore
