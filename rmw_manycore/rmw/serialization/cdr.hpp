// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "rmw/serialization/cdr_lengths.hpp"
#include "rosidl_typesupport_fastrtps_cpp/message_type_support.h"

namespace rmw_manycore {

/// Serializes messages of one type to CDR (XCDR version 1, plain, with encapsulation header) and
/// back. Writes the same bytes as rmw_fastrtps_cpp. Allocates no memory itself. Stateless.
class Cdr {
public:
  Cdr(
    const message_type_support_callbacks_t & callbacks, std::shared_ptr<const CdrLengths> lengths);

  /// Upper bound of the bytes that serialize() writes: exact, except rounded up for types of fixed
  /// size.
  size_t size_bound(const void * message) const;

  /// Size of a message in memory if that equals its CDR layout (plain types: fixed size, no
  /// allocations, no padding of its own), else 0.
  size_t plain_bytes() const noexcept { return plain_bytes_; }

  /// Returns the number of bytes written, padding included. Throws manycore::Error.
  size_t serialize(const void * message, uint8_t * data, size_t capacity) const;

  /// Throws std::bad_alloc or manycore::Error; `message` is then unspecified.
  void deserialize(const uint8_t * data, size_t size, void * message) const;

  /// See CdrLengths::cut(). Throws manycore::Error for data that deserialize() would reject.
  CutCdr cut(const uint8_t * data, size_t size, size_t min_bytes) const;
  const std::vector<NumberSequence> & number_sequences() const {
    return lengths_->number_sequences();
  }

private:
  size_t write(const void * message, uint8_t * data, size_t capacity) const;
  void read(const uint8_t * data, size_t size, void * message) const;
  /// Throws manycore::Error for data that the type support must not read.
  void check(const uint8_t * data, size_t size) const;
  /// Reason to reject the data, or null if the type support may read it.
  const char * why_unreadable(const uint8_t * data, size_t size) const;

  const message_type_support_callbacks_t * callbacks_;
  std::shared_ptr<const CdrLengths> lengths_;
  size_t fixed_size_bound_ = 0;  ///< nonzero for types whose size does not depend on the message
  size_t plain_bytes_ = 0;
  bool empty_ = false;  ///< no members: serialized as one filler byte
};

}  // namespace rmw_manycore
