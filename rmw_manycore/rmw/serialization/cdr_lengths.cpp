// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/cdr_lengths.hpp"

#include "rcutils/error_handling.h"
#include "rosidl_typesupport_introspection_c/message_introspection.h"
#include "rosidl_typesupport_introspection_c/service_introspection.h"
#include "rosidl_typesupport_introspection_cpp/message_introspection.hpp"
#include "rosidl_typesupport_introspection_cpp/service_introspection.hpp"

namespace rmw_manycore {
namespace {

// Compared by text, as rosidl does, so that the introspection libraries need not be linked.
constexpr const char * c_identifier = "rosidl_typesupport_introspection_c";
constexpr const char * cpp_identifier = "rosidl_typesupport_introspection_cpp";

using CMembers = rosidl_typesupport_introspection_c__MessageMembers;
using CServiceMembers = rosidl_typesupport_introspection_c__ServiceMembers;
using CppMembers = rosidl_typesupport_introspection_cpp::MessageMembers;
using CppServiceMembers = rosidl_typesupport_introspection_cpp::ServiceMembers;

/// Bit of the second byte of the encapsulation header.
constexpr uint8_t little_endian_bit = 1;
constexpr bool is_little_endian = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;

bool is_swapped(const uint8_t * cdr) noexcept {
  return ((cdr[1] & little_endian_bit) != 0) != is_little_endian;
}

}  // namespace

const char * CdrLengths::find_fault(const uint8_t * cdr, size_t size) const {
  return plan().find_fault(cdr + encapsulation_bytes, size - encapsulation_bytes, is_swapped(cdr));
}

CutCdr CdrLengths::cut(const uint8_t * cdr, size_t size, size_t min_bytes) const {
  return plan().is_whole() && !is_swapped(cdr) ? CutCdr::of(plan(), cdr, size, min_bytes)
                                               : CutCdr{};
}

bool CdrLengths::know_padding() const { return plan().is_whole(); }

void CdrLengths::clear_padding(uint8_t * cdr, size_t size) const {
  plan().clear_padding(cdr + encapsulation_bytes, size - encapsulation_bytes);
}

const LengthPlan & CdrLengths::plan() const {
  std::call_once(looked_, [this] { plan_ = make_plan(); });
  return plan_;
}

LengthPlan CdrLengths::make_plan() const {
  if (const auto * const members = find<CMembers, CServiceMembers>(c_identifier)) {
    return LengthPlan::of(*members);
  }
  if (const auto * const members = find<CppMembers, CppServiceMembers>(cpp_identifier)) {
    return LengthPlan::of(*members);
  }
  return {};
}

template<typename Members, typename ServiceMembers>
const Members * CdrLengths::find(const char * identifier) const {
  const Members * members = nullptr;
  if (message_ != nullptr) {
    const auto * const found = get_message_typesupport_handle(message_, identifier);
    members = found == nullptr ? nullptr : static_cast<const Members *>(found->data);
  } else if (const auto * const found = get_service_typesupport_handle(service_, identifier)) {
    const auto & service = *static_cast<const ServiceMembers *>(found->data);
    members = part_ == Part::request ? service.request_members_ : service.response_members_;
  }
  if (members == nullptr) {
    rcutils_reset_error();
  }
  return members;
}

}  // namespace rmw_manycore
