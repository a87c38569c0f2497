// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "rmw/serialization/cdr_lengths.hpp"
#include "rosidl_typesupport_fastrtps_cpp/message_type_support.h"

namespace rmw_manycore {

/// How messages of one type become CDR bytes (XCDR version 1, plain, with encapsulation header) and
/// back. The bytes are those that rmw_fastrtps_cpp writes. Allocates nothing itself. Stateless.
class Cdr {
public:
  Cdr(
    const message_type_support_callbacks_t & callbacks, std::shared_ptr<const CdrLengths> lengths);

  /// An upper bound of what `serialize` writes: the exact size, rounded up for types of fixed size.
  size_t size_bound(const void * message) const;

  /// Bytes of a message in memory, where that has the layout of its CDR (plain types: of fixed
  /// size, nothing allocated, no padding of its own); else 0.
  size_t plain_bytes() const noexcept { return plain_bytes_; }

  /// Returns the number of bytes written; throws manycore::Error or a Fast CDR exception.
  size_t serialize(const void * message, uint8_t * data, size_t capacity) const;

  /// Throws manycore::Error or a Fast CDR exception; `message` is then in an undefined state.
  void deserialize(const uint8_t * data, size_t size, void * message) const;

private:
  /// Null for what the type support may read.
  const char * why_unreadable(const uint8_t * data, size_t size) const;

  const message_type_support_callbacks_t * callbacks_;
  std::shared_ptr<const CdrLengths> lengths_;
  size_t fixed_size_bound_ = 0;  ///< of types whose size does not depend on the message; else 0
  size_t plain_bytes_ = 0;
  bool empty_ = false;  ///< has no members: one filler byte stands for it
};

}  // namespace rmw_manycore
