// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/cdr.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "fastcdr/Cdr.h"
#include "fastcdr/FastBuffer.h"
#include "fastcdr/exceptions/Exception.h"
#include "platform/error.hpp"

namespace rmw_manycore {
namespace {

/// Second byte of the encapsulation header: the first value that means XCDR version 2.
constexpr uint8_t first_of_xcdr2 = 6;

/// To clear a buffer of this size takes less than a tenth of the time of publishing it. In larger
/// ones only the padding is cleared.
constexpr size_t max_cleared_bytes = 1024;

/// Whether exceptions of Fast CDR derive from std::exception depends on its version.
template<typename Body>
auto translate_exceptions(Body && body) {
  try {
    return body();
  } catch (const eprosima::fastcdr::exception::Exception & error) {
    throw manycore::Error(manycore::ErrorCode::corrupt, error.what());
  }
}

}  // namespace

Cdr::Cdr(
  const message_type_support_callbacks_t & callbacks, std::shared_ptr<const CdrLengths> lengths)
: callbacks_(&callbacks), lengths_(std::move(lengths)) {
  char bounds = ROSIDL_TYPESUPPORT_FASTRTPS_UNBOUNDED_TYPE;
  const size_t max_size = callbacks.max_serialized_size(bounds);
  if (bounds == ROSIDL_TYPESUPPORT_FASTRTPS_PLAIN_TYPE) {
    empty_ = max_size == 0;
    // In memory the last member may be followed by padding, up to the largest alignment.
    plain_bytes_ = (max_size / alignof(max_align_t) + 1) * alignof(max_align_t);
    // Rounded up to 4 bytes as rmw_fastrtps_cpp does, so that rmw_serialize gives equal lengths.
    fixed_size_bound_ = (encapsulation_bytes + (empty_ ? 1 : max_size) + 3) & ~size_t{3};
  }
}

size_t Cdr::size_bound(const void * message) const {
  return fixed_size_bound_ != 0 ? fixed_size_bound_
                                : encapsulation_bytes + callbacks_->get_serialized_size(message);
}

size_t Cdr::serialize(const void * message, uint8_t * data, size_t capacity) const {
  const bool clears_all = capacity <= max_cleared_bytes || !lengths_->know_padding();
  if (clears_all) {
    std::fill_n(data, capacity, uint8_t{0});
  }
  const size_t size = translate_exceptions([&] { return write(message, data, capacity); });
  if (!clears_all) {
    lengths_->clear_padding(data, size);
  }
  return size;
}

size_t Cdr::write(const void * message, uint8_t * data, size_t capacity) const {
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char *>(data), capacity);
  eprosima::fastcdr::Cdr cdr(
    buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN, eprosima::fastcdr::CdrVersion::XCDRv1);
  cdr.set_encoding_flag(eprosima::fastcdr::EncodingAlgorithmFlag::PLAIN_CDR);
  cdr.serialize_encapsulation();
  if (empty_) {
    cdr << char{0};  // unlike that of uint8_t, in the Fast CDR of every distribution
  } else if (!callbacks_->cdr_serialize(message, cdr)) {
    throw manycore::Error(
      manycore::ErrorCode::invalid_argument,
      std::string("cannot serialize a message of type ") + callbacks_->message_name_);
  }
  return cdr.get_serialized_data_length();
}

/// Rejects encodings that ROS 2 never writes: for XCDR2, the C++ type support would resize
/// sequences of strings to any length found in the data.
const char * Cdr::why_unreadable(const uint8_t * data, size_t size) const {
  if (size < encapsulation_bytes) {
    return "it has no encapsulation header";
  }
  if (data[1] >= first_of_xcdr2) {
    return "it is not XCDR version 1";
  }
  return lengths_->find_fault(data, size);
}

void Cdr::check(const uint8_t * data, size_t size) const {
  if (const char * const reason = why_unreadable(data, size)) {
    throw manycore::Error(manycore::ErrorCode::corrupt, reason);
  }
}

void Cdr::deserialize(const uint8_t * data, size_t size, void * message) const {
  check(data, size);
  translate_exceptions([&] { read(data, size, message); });
}

CutCdr Cdr::cut(const uint8_t * data, size_t size, size_t min_bytes) const {
  check(data, size);
  return lengths_->cut(data, size, min_bytes);
}

void Cdr::read(const uint8_t * data, size_t size, void * message) const {
  // FastBuffer takes no const data; deserialization only reads.
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char *>(const_cast<uint8_t *>(data)), size);
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN);
  cdr.read_encapsulation();
  if (empty_) {
    uint8_t filler = 0;
    cdr >> filler;
  } else if (!callbacks_->cdr_deserialize(cdr, message)) {
    throw manycore::Error(
      manycore::ErrorCode::corrupt,
      std::string("cannot deserialize a message of type ") + callbacks_->message_name_);
  }
}

}  // namespace rmw_manycore
