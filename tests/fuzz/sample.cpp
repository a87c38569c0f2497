// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "sample.hpp"

#include <cstring>
#include <stdexcept>

#include "rosidl_typesupport_introspection_c/field_types.h"

namespace {

constexpr size_t header_bytes = 4;
constexpr size_t length_bytes = 4;
/// A sample larger than this gets no further elements, because nested sequences grow fast.
constexpr size_t enough_bytes = 4096;

/// Writes XCDR version 1, little-endian.
class Writer {
public:
  explicit Writer(Random & random) : random_(random) { sample_.cdr = {0, 1, 0, 0}; }

  void message(const Members & type) {
    for (uint32_t i = 0; i < type.member_count_; ++i) {
      member(type.members_[i]);
    }
  }
  Sample result() && { return std::move(sample_); }

private:
  void member(const Member & member) {
    size_t count = 1;
    if (member.is_array_ && member.array_size_ != 0 && !member.is_upper_bound_) {
      count = member.array_size_;
    } else if (member.is_array_) {
      count = length(element_limit(member.is_upper_bound_ ? member.array_size_ : 5));
    }
    for (; count != 0; --count) {
      element(member);
    }
  }
  size_t element_limit(size_t limit) const { return sample_.cdr.size() > enough_bytes ? 0 : limit; }

  void element(const Member & member) {
    switch (member.type_id_) {
      case rosidl_typesupport_introspection_c__ROS_TYPE_BOOLEAN:
        return number(choose(random_, 0, 1), 1);
      case rosidl_typesupport_introspection_c__ROS_TYPE_CHAR:
      case rosidl_typesupport_introspection_c__ROS_TYPE_OCTET:
      case rosidl_typesupport_introspection_c__ROS_TYPE_UINT8:
      case rosidl_typesupport_introspection_c__ROS_TYPE_INT8:
        return number(is_filler(member) ? 0 : random_(), 1);
      case rosidl_typesupport_introspection_c__ROS_TYPE_UINT16:
      case rosidl_typesupport_introspection_c__ROS_TYPE_INT16:
        return number(random_(), 2);
      case rosidl_typesupport_introspection_c__ROS_TYPE_FLOAT:
      case rosidl_typesupport_introspection_c__ROS_TYPE_UINT32:
      case rosidl_typesupport_introspection_c__ROS_TYPE_INT32:
        return number(random_(), 4);
      case rosidl_typesupport_introspection_c__ROS_TYPE_DOUBLE:
      case rosidl_typesupport_introspection_c__ROS_TYPE_UINT64:
      case rosidl_typesupport_introspection_c__ROS_TYPE_INT64:
        return number(random_(), 8);
      case rosidl_typesupport_introspection_c__ROS_TYPE_STRING:
        return string(member);
      case rosidl_typesupport_introspection_c__ROS_TYPE_WSTRING:
        return wide_string(member);
      case rosidl_typesupport_introspection_c__ROS_TYPE_MESSAGE:
        return message(*static_cast<const Members *>(member.members_->data));
      default:
        throw std::runtime_error(std::string("cannot write ") + member.name_);
    }
  }
  /// Messages without fields have a generated one, whose value is not preserved.
  static bool is_filler(const Member & member) {
    return std::strcmp(member.name_, "structure_needs_at_least_one_member") == 0;
  }

  size_t characters(const Member & member) const {
    return member.string_upper_bound_ != 0 ? member.string_upper_bound_ : 12;
  }
  void string(const Member & member) {
    const size_t count = choose(random_, 0, characters(member));
    put_length(count + 1);
    for (size_t i = 0; i < count; ++i) {
      number(choose(random_, 1, 127), 1);
    }
    number(0, 1);
  }
  void wide_string(const Member & member) {
    const size_t count = length(characters(member));
    for (size_t i = 0; i < count; ++i) {
      number(choose(random_, 1, 0xd7ff), 4);
    }
  }

  size_t length(size_t limit) {
    const size_t count = choose(random_, 0, limit);
    put_length(count);
    return count;
  }
  void put_length(size_t count) {
    align(length_bytes);
    sample_.lengths.push_back(sample_.cdr.size());
    number(count, length_bytes);
  }
  void number(uint64_t value, size_t bytes) {
    align(bytes);
    for (; bytes != 0; --bytes, value >>= 8) {
      sample_.cdr.push_back(static_cast<uint8_t>(value));
    }
  }
  void align(size_t bytes) {
    while ((sample_.cdr.size() - header_bytes) % bytes != 0) {
      sample_.cdr.push_back(0);
    }
  }

  Random & random_;
  Sample sample_;
};

void put_length(Sample & sample, size_t at, uint32_t value) {
  if (at + length_bytes <= sample.cdr.size()) {
    std::memcpy(sample.cdr.data() + at, &value, length_bytes);
  }
}

void change_length(Sample & sample, Random & random) {
  const size_t at = sample.lengths[choose(random, 0, sample.lengths.size() - 1)];
  const auto left = static_cast<uint32_t>(sample.cdr.size() - std::min(sample.cdr.size(), at));
  const uint32_t values[] = {
    0,          1,          2,         left - 4, left - 3,
    left,       left / 4,   left / 8,  left + 1, static_cast<uint32_t>(choose(random, 0, 300)),
    0x7fffffff, 0x80000000, 0xffffffff};
  put_length(sample, at, values[choose(random, 0, std::size(values) - 1)]);
}

void change_byte(Sample & sample, Random & random) {
  sample.cdr[choose(random, 0, sample.cdr.size() - 1)] = static_cast<uint8_t>(random());
}

void copy_part(Sample & sample, Random & random) {
  const size_t from = choose(random, 0, sample.cdr.size() - 1);
  const size_t to = choose(random, 0, sample.cdr.size() - 1);
  const size_t most = sample.cdr.size() - std::max(from, to);
  std::memmove(sample.cdr.data() + to, sample.cdr.data() + from, choose(random, 1, most));
}

}  // namespace

uint64_t choose(Random & random, uint64_t first, uint64_t last) {
  return first + random() % (last - first + 1);
}

Sample make_sample(const Members & type, Random & random) {
  Writer writer(random);
  writer.message(type);
  return std::move(writer).result();
}

void mutate(Sample & sample, Random & random) {
  for (uint64_t left = choose(random, 1, 4); left != 0 && !sample.cdr.empty(); --left) {
    switch (choose(random, 0, 15)) {
      case 0:
        sample.cdr.resize(choose(random, 0, sample.cdr.size()));
        break;
      case 1:
        sample.cdr.resize(sample.cdr.size() + choose(random, 1, 40), 0xff);
        break;
      case 2:
        sample.cdr[choose(random, 0, std::min<size_t>(sample.cdr.size(), header_bytes) - 1)] ^=
          static_cast<uint8_t>(1 << choose(random, 0, 3));
        break;
      case 3:
      case 4:
        copy_part(sample, random);
        break;
      case 5:
      case 6:
      case 7:
        change_byte(sample, random);
        break;
      default:
        if (!sample.lengths.empty()) {
          change_length(sample, random);
        }
    }
  }
}
