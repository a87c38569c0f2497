// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>

#include "rmw/serialization/cut_cdr.hpp"
#include "rmw/serialization/length_plan.hpp"
#include "rosidl_runtime_c/message_type_support_struct.h"
#include "rosidl_runtime_c/service_type_support_struct.h"

namespace rmw_manycore {

/// Checks the lengths in a message's CDR against the remaining bytes. The generated type support
/// resizes a wide string before reading it, assumes one byte per element whatever its size, and
/// continues after a nested message has failed, so a few bytes from the network could claim
/// gigabytes. Also clears padding, which Fast CDR skips without writing it. Thread-safe.
class CdrLengths {
public:
  explicit CdrLengths(const rosidl_message_type_support_t & message) noexcept
  : message_(&message) {}

  enum class Part { request, response };
  CdrLengths(const rosidl_service_type_support_t & service, Part part) noexcept
  : service_(&service), part_(part) {}

  /// What is wrong, as of LengthPlan, or null. Requires CDR version 1 with encapsulation header.
  const char * find_fault(const uint8_t * cdr, size_t size) const;

  /// Whether the type is known well enough for clear_padding().
  bool know_padding() const;
  /// Clears the padding of a message that this process serialized.
  void clear_padding(uint8_t * cdr, size_t size) const;

  const std::vector<NumberSequence> & number_sequences() const { return plan().number_sequences(); }
  /// As CutCdr::of(); nothing is cut of a type that is not known well enough, or of a message in
  /// the opposite byte order.
  CutCdr cut(const uint8_t * cdr, size_t size, size_t min_bytes) const;

private:
  /// Made for the first message, because it loads the introspection library, which a publisher of
  /// small messages never needs. For a type without introspection nothing is checked.
  const LengthPlan & plan() const;
  LengthPlan make_plan() const;
  template<typename Members, typename ServiceMembers>
  const Members * find(const char * identifier) const;

  const rosidl_message_type_support_t * message_ = nullptr;
  const rosidl_service_type_support_t * service_ = nullptr;
  Part part_ = Part::request;

  mutable std::once_flag looked_;
  mutable LengthPlan plan_;
};

}  // namespace rmw_manycore
