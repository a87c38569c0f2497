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

bool is_kept(const RecordHold * hold) noexcept { return hold->hold.is_kept(); }

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

template<typename Sequence>
void refer(void * place, void * data, size_t count) noexcept {
  Sequence sequence{};  // further members, which some distributions have, are those of an empty one
  sequence.data = static_cast<decltype(sequence.data)>(data);
  sequence.size = count;
  sequence.capacity = count;
  *static_cast<Sequence *>(place) = sequence;
}

/// By type code of array.array.
using Refer = void (*)(void *, void *, size_t) noexcept;
Refer refer_of(char typecode) noexcept {
  switch (typecode) {
    case 'f':
      return refer<rosidl_runtime_c__float__Sequence>;
    case 'd':
      return refer<rosidl_runtime_c__double__Sequence>;
    case 'b':
      return refer<rosidl_runtime_c__int8__Sequence>;
    case 'h':
      return refer<rosidl_runtime_c__int16__Sequence>;
    case 'H':
      return refer<rosidl_runtime_c__uint16__Sequence>;
    case 'i':
      return refer<rosidl_runtime_c__int32__Sequence>;
    case 'I':
      return refer<rosidl_runtime_c__uint32__Sequence>;
    case 'q':
      return refer<rosidl_runtime_c__int64__Sequence>;
    case 'Q':
      return refer<rosidl_runtime_c__uint64__Sequence>;
    default:
      return refer<rosidl_runtime_c__uint8__Sequence>;
  }
}

void lend(void * message, size_t offset, char typecode, void * data, size_t count) noexcept {
  refer_of(typecode)(static_cast<uint8_t *>(message) + offset, data, count);
}

constexpr BorrowingInterface functions{adopt,     forget,  borrowed,  take_hold, access,
                                       give_back, is_kept, offset_of, lend};

}  // namespace
}  // namespace rmw_manycore

// NOLINTNEXTLINE(readability-identifier-naming): exported like the rmw interface
extern "C" __attribute__((visibility("default"))) const rmw_manycore::BorrowingInterface *
rmw_manycore_borrowing_4() {
  return &rmw_manycore::functions;
}
