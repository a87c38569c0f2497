// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace rmw_manycore {

/// Shorter sequences are copied: that takes less time than to borrow them.
constexpr size_t min_borrowed_bytes = size_t{64} << 10;

/// Keeps the bytes of a record in place, see manycore::Hold.
struct RecordHold;

/// What the holder of a record may do with its bytes.
enum class Access : uint8_t {
  copy,  ///< for want of more: other readers may write into theirs
  read,
  write,  ///< nothing else reads them
};

/// The elements of a large sequence, where they lie in the record.
struct BorrowedSequence {
  const char * path;  ///< as NumberSequence::path
  uint8_t * data;
  size_t count;
};

/// What librmw_manycore.so does for the converters of Python messages, found by the name of the
/// function below. Thread-safe; nothing throws.
struct BorrowingInterface {
  /// From now on rmw_take leaves large sequences of numbers of `message` in the record, if it can:
  /// the message gets a few elements of them. `is_read_only`: whether its
  /// owner only reads them, unless the topic has another mode. False for want of memory.
  bool (*adopt)(void * message, bool is_read_only) noexcept;
  /// Ends this, and gives back the record if it is still held. Before the message is destroyed.
  void (*forget)(void * message) noexcept;

  /// The sequences that the message left in its record; valid until it is forgotten.
  const BorrowedSequence * (*borrowed)(const void * message, size_t * count) noexcept;
  /// Hands the message's hold to the caller; null if it borrows nothing.
  RecordHold * (*take_hold)(void * message) noexcept;
  Access (*access)(const RecordHold * hold) noexcept;
  void (*give_back)(RecordHold * hold) noexcept;
  /// In a child of fork(), after it has read the record: false if the parent was dead by then, so
  /// that what was read may be torn.
  bool (*is_kept)(const RecordHold * hold) noexcept;

  /// Place of a sequence in messages of a type (rosidl_message_type_support_t), SIZE_MAX if it has
  /// no such sequence with elements of this type code.
  size_t (*offset_of)(const void * type_support, const char * path, char typecode) noexcept;
  /// Lets an empty sequence of a message, with elements of this type code, refer to elements of the
  /// caller; null takes them back.
  void (*lend)(void * message, size_t offset, char typecode, void * data, size_t count) noexcept;
};

constexpr char borrowing_function[] = "rmw_manycore_borrowing_4";
using BorrowingFunction = const BorrowingInterface * (*)();

}  // namespace rmw_manycore
