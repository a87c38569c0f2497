// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/cdr_lengths.hpp"

#include "rcutils/error_handling.h"
#include "rmw/serialization/length_walk.hpp"
#include "rosidl_typesupport_introspection_c/message_introspection.h"
#include "rosidl_typesupport_introspection_c/service_introspection.h"
#include "rosidl_typesupport_introspection_cpp/message_introspection.hpp"
#include "rosidl_typesupport_introspection_cpp/service_introspection.hpp"

namespace rmw_manycore {
namespace {

// As rosidl compares them: by text, so that the libraries need not be linked.
constexpr const char * c_identifier = "rosidl_typesupport_introspection_c";
constexpr const char * cpp_identifier = "rosidl_typesupport_introspection_cpp";

using CMembers = rosidl_typesupport_introspection_c__MessageMembers;
using CServiceMembers = rosidl_typesupport_introspection_c__ServiceMembers;
using CppMembers = rosidl_typesupport_introspection_cpp::MessageMembers;
using CppServiceMembers = rosidl_typesupport_introspection_cpp::ServiceMembers;

/// The second byte of the header says how the rest is encoded; the lowest bit is its byte order.
constexpr size_t encapsulation_bytes = 4;
constexpr uint8_t little_endian_bit = 1;
constexpr uint8_t first_of_xcdr2 = 6;
constexpr bool is_little_endian = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;

template<typename Members>
bool walk(const void * members, const uint8_t * cdr, size_t size) {
  const bool swapped = ((cdr[1] & little_endian_bit) != 0) != is_little_endian;
  const size_t widest = cdr[1] >= first_of_xcdr2 ? 4 : 8;
  LengthWalk<Members> walk(cdr + encapsulation_bytes, size - encapsulation_bytes, swapped, widest);
  return walk.fits(*static_cast<const Members *>(members));
}

}  // namespace

bool CdrLengths::fit(const uint8_t * cdr, size_t size) const {
  std::call_once(looked_, [this] { find_members(); });
  if (size < encapsulation_bytes) {
    return true;  // Fast CDR says so
  }
  if (c_members_ != nullptr) {
    return walk<CMembers>(c_members_, cdr, size);
  }
  // In XCDR2 the C++ type support reads some sequences with a header of their own.
  const bool is_plain = cdr[1] < first_of_xcdr2;
  return cpp_members_ == nullptr || !is_plain || walk<CppMembers>(cpp_members_, cdr, size);
}

void CdrLengths::find_members() const {
  const auto * const c = find<CMembers, CServiceMembers>(c_identifier);
  const auto * const cpp =
    c == nullptr ? find<CppMembers, CppServiceMembers>(cpp_identifier) : nullptr;
  c_members_ = c != nullptr && LengthWalk<CMembers>::has_lengths(*c) ? c : nullptr;
  cpp_members_ = cpp != nullptr && LengthWalk<CppMembers>::has_lengths(*cpp) ? cpp : nullptr;
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
