// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <manycore_reference_msgs/msg/message4kb.h>
#include <manycore_reference_msgs/msg/transmission_stats.h>
#include <rosidl_runtime_c/message_type_support_struct.h>

#include <cstddef>
#include <cstdint>
#include <string>

/// Messages of the reference system: records of the nodes they passed, and a payload. All sizes
/// have the same beginning, so this code uses one type and the number of payload bytes.
namespace manycore::bench::reference {

using Message = manycore_reference_msgs__msg__Message4kb;
using Record = manycore_reference_msgs__msg__TransmissionStats;

constexpr uint64_t max_records = manycore_reference_msgs__msg__Message4kb__STATS_CAPACITY;

/// Type support and size of a message type.
struct MessageType {
  const rosidl_message_type_support_t * support;
  size_t bytes;

  size_t payload_words() const { return (bytes - offsetof(Message, data)) / sizeof(int64_t); }
};

/// Type by full name, such as "manycore_reference_msgs/msg/Message4kb".
MessageType message_type(const std::string & name);

uint64_t system_now_ns();

void add_record(
  Message & message, const std::string & name, uint64_t timestamp_ns, uint32_t sequence,
  uint32_t dropped);
/// Copies the records of nodes that `message` has no record of.
void merge_records(Message & message, const Message & source);
/// Sequence number given by the sender, whose record is the last one.
uint32_t sequence_of(const Message & message);

/// `data` holds the result of the callback's work, a checksum, and the words it sums.
void write_payload(Message & message, const MessageType & type, uint32_t sequence);
/// Throws if the checksum does not match.
void check_payload(const Message & message, const MessageType & type, const std::string & topic);

/// Counts missing sequence numbers, starting with the first one received.
class Gaps {
public:
  uint32_t before(uint32_t sequence) {
    const uint32_t missing = begun_ && sequence > last_ ? sequence - last_ - 1 : 0;
    begun_ = true;
    last_ = sequence;
    return missing;
  }

private:
  bool begun_ = false;
  uint32_t last_ = 0;
};

}  // namespace manycore::bench::reference
