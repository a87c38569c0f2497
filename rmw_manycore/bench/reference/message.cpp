// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/reference/message.hpp"

#include <manycore_reference_msgs/msg/message1024kb.h>
#include <manycore_reference_msgs/msg/message256kb.h>
#include <manycore_reference_msgs/msg/message5120kb.h>
#include <manycore_reference_msgs/msg/message64kb.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>

#include "platform/clock.hpp"

namespace manycore::bench::reference {

namespace {

constexpr size_t checksum = 1;
constexpr size_t first_word = 2;

template<typename Type>
constexpr bool begins_as_message() {
  return offsetof(Type, size) == offsetof(Message, size) &&
         offsetof(Type, stats) == offsetof(Message, stats) &&
         offsetof(Type, data) == offsetof(Message, data);
}

#define MESSAGE(kind)                                                  \
  {                                                                    \
    "manycore_reference_msgs/msg/" #kind, MessageType {                \
      ROSIDL_GET_MSG_TYPE_SUPPORT(manycore_reference_msgs, msg, kind), \
        sizeof(manycore_reference_msgs__msg__##kind)                   \
    }                                                                  \
  }
static_assert(sizeof(Record) == 64);
static_assert(sizeof(Message) == 4096);
static_assert(begins_as_message<manycore_reference_msgs__msg__Message64kb>());
static_assert(begins_as_message<manycore_reference_msgs__msg__Message256kb>());
static_assert(begins_as_message<manycore_reference_msgs__msg__Message1024kb>());
static_assert(begins_as_message<manycore_reference_msgs__msg__Message5120kb>());

bool is_of(const Record & record, const Record & other) {
  return std::memcmp(record.node_name, other.node_name, sizeof(record.node_name)) == 0;
}

/// The payload extends beyond the array that the smallest message declares.
int64_t * words_of(Message & message) {
  return reinterpret_cast<int64_t *>(
    reinterpret_cast<std::byte *>(&message) + offsetof(Message, data));
}

const int64_t * words_of(const Message & message) {
  return reinterpret_cast<const int64_t *>(
    reinterpret_cast<const std::byte *>(&message) + offsetof(Message, data));
}

int64_t sum(const int64_t * words, size_t count) {
  uint64_t total = 0;  // wraps around
  for (size_t i = first_word; i < count; ++i) {
    total += static_cast<uint64_t>(words[i]);
  }
  return static_cast<int64_t>(total);
}

}  // namespace

MessageType message_type(const std::string & name) {
  static const std::map<std::string, MessageType> types = {
    MESSAGE(Message4kb), MESSAGE(Message64kb), MESSAGE(Message256kb), MESSAGE(Message1024kb),
    MESSAGE(Message5120kb)};
  const auto found = types.find(name);
  if (found == types.end()) {
    throw std::invalid_argument("expected a type of manycore_reference_msgs, found " + name);
  }
  return found->second;
}

uint64_t system_now_ns() { return static_cast<uint64_t>(realtime_ns()); }

void add_record(
  Message & message, const std::string & name, uint64_t timestamp_ns, uint32_t sequence,
  uint32_t dropped) {
  if (message.size >= max_records) {
    return;
  }
  Record & record = message.stats[message.size++];
  record.timestamp = timestamp_ns;
  record.sequence_number = sequence;
  record.dropped_samples = dropped;
  std::memset(record.node_name, 0, sizeof(record.node_name));
  std::memcpy(record.node_name, name.data(), std::min(name.size(), sizeof(record.node_name) - 1));
}

void merge_records(Message & message, const Message & source) {
  const uint64_t known = message.size;
  for (uint64_t i = 0; i < source.size && message.size < max_records; ++i) {
    const Record & record = source.stats[i];
    if (std::none_of(message.stats, message.stats + known, [&](const Record & other) {
          return is_of(record, other);
        })) {
      message.stats[message.size++] = record;
    }
  }
}

uint32_t sequence_of(const Message & message) {
  return message.size == 0 ? 0 : message.stats[message.size - 1].sequence_number;
}

void write_payload(Message & message, const MessageType & type, uint32_t sequence) {
  int64_t * const words = words_of(message);
  for (size_t i = first_word; i < type.payload_words(); ++i) {
    words[i] = static_cast<int64_t>(sequence + i);
  }
  words[checksum] = sum(words, type.payload_words());
}

void check_payload(const Message & message, const MessageType & type, const std::string & topic) {
  const int64_t * const words = words_of(message);
  const int64_t found = sum(words, type.payload_words());
  if (found != words[checksum]) {
    throw std::runtime_error(
      topic + ": expected a payload with the sum " + std::to_string(words[checksum]) + ", found " +
      std::to_string(found));
  }
}

}  // namespace manycore::bench::reference
