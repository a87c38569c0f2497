// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/borrowing/interface.hpp"

#include <exception>

#include "rmw/borrowing/adopted.hpp"
#include "rmw/serialization/type_support.hpp"
#include "rosidl_runtime_c/primitives_sequence.h"

namespace rmw_manycore {
namespace {

bool adopt(void * message, bool is_read_only) noexcept {
  try {
    Adopted::messages().add(message, is_read_only);
    return true;
  } catch (const std::exception &) {
    return false;
  }
}

void forget(void * message) noexcept { Adopted::messages().remove(message); }

const BorrowedSequence * borrowed(const void * message, size_t * count) noexcept {
  const AdoptedMessage * const found = Adopted::messages().find(message);
  *count = found == nullptr ? 0 : found->borrowed.sequences.size();
  return *count == 0 ? nullptr : found->borrowed.sequences.data();
}

RecordHold * take_hold(void * message) noexcept {
  AdoptedMessage * const found = Adopted::messages().find(message);
  return found == nullptr ? nullptr : found->borrowed.hold.release();
}

Access access(const RecordHold * hold) noexcept { return hold->access; }

void give_back(RecordHold * hold) noexcept { delete hold; }

size_t offset_of(const void * type_support, const char * path, char typecode) noexcept {
  try {
    const Cdr cdr = cdr_of(static_cast<const rosidl_message_type_support_t *>(type_support));
    for (const NumberSequence & sequence : cdr.number_sequences()) {
      if (sequence.path == path && sequence.typecode == typecode) {
        return sequence.offset;
      }
    }
  } catch (const std::exception &) {
    // no type support: its messages are converted as upstream does
  }
  return SIZE_MAX;
}

/// Sequences of all numbers have the same layout.
void lend(void * message, size_t offset, void * data, size_t count) noexcept {
  auto & sequence = *reinterpret_cast<rosidl_runtime_c__uint8__Sequence *>(
    static_cast<uint8_t *>(message) + offset);
  sequence.data = static_cast<uint8_t *>(data);
  sequence.size = count;
  sequence.capacity = count;
}

template<typename Sequence>
constexpr bool is_laid_out_alike =
  offsetof(Sequence, data) == 0 && offsetof(Sequence, size) == sizeof(void *) &&
  offsetof(Sequence, capacity) == 2 * sizeof(void *);
static_assert(is_laid_out_alike<rosidl_runtime_c__uint8__Sequence>);
static_assert(is_laid_out_alike<rosidl_runtime_c__double__Sequence>);

constexpr BorrowingInterface functions{adopt,  forget,    borrowed,  take_hold,
                                       access, give_back, offset_of, lend};

}  // namespace
}  // namespace rmw_manycore

// NOLINTNEXTLINE(readability-identifier-naming): exported like the rmw interface
extern "C" __attribute__((visibility("default"))) const rmw_manycore::BorrowingInterface *
rmw_manycore_borrowing_2() {
  return &rmw_manycore::functions;
}
