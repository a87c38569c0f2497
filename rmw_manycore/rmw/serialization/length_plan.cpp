// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/serialization/length_plan.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>

#include "rosidl_typesupport_introspection_c/field_types.h"
#include "rosidl_typesupport_introspection_c/message_introspection.h"
#include "rosidl_typesupport_introspection_cpp/message_introspection.hpp"

namespace rmw_manycore {
namespace {

constexpr size_t length_bytes = 4;
constexpr size_t wide_character_bytes = 4;
constexpr uint32_t swapped_byte_order_mark = 0xFFFE;

/// Type ids are equal in C and C++. 0 for types that are not primitive or not defined in CDR.
constexpr size_t primitive_bytes(uint8_t type_id) noexcept {
  switch (type_id) {
    case rosidl_typesupport_introspection_c__ROS_TYPE_CHAR:
    case rosidl_typesupport_introspection_c__ROS_TYPE_BOOLEAN:
    case rosidl_typesupport_introspection_c__ROS_TYPE_OCTET:
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT8:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT8:
      return 1;
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT16:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT16:
      return 2;
    case rosidl_typesupport_introspection_c__ROS_TYPE_FLOAT:
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT32:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT32:
      return 4;
    case rosidl_typesupport_introspection_c__ROS_TYPE_DOUBLE:
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT64:
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT64:
      return 8;
    default:
      return 0;
  }
}

/// Type code of the array.array in which rclpy keeps a sequence; 0 where it keeps a list.
constexpr char typecode(uint8_t type_id) noexcept {
  switch (type_id) {
    case rosidl_typesupport_introspection_c__ROS_TYPE_FLOAT:
      return 'f';
    case rosidl_typesupport_introspection_c__ROS_TYPE_DOUBLE:
      return 'd';
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT8:
      return 'b';
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT8:
      return 'B';
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT16:
      return 'h';
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT16:
      return 'H';
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT32:
      return 'i';
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT32:
      return 'I';
    case rosidl_typesupport_introspection_c__ROS_TYPE_INT64:
      return 'q';
    case rosidl_typesupport_introspection_c__ROS_TYPE_UINT64:
      return 'Q';
    default:
      return 0;
  }
}

}  // namespace

/// Makes the plan of one type. Stops at a type whose CDR is undefined (long double, wide
/// character), because the position of everything after it is unknown.
template<typename Members>
class LengthPlanner {
public:
  /// Where the fields of a message are, seen from the outermost one.
  struct Place {
    std::string prefix;
    size_t offset = 0;
    bool is_single = true;  ///< not in elements of a sequence or array
  };

  LengthPlan plan(const Members & type, const Place & place) {
    LengthPlan plan;
    for (uint32_t i = 0; i < type.member_count_ && !is_at_unknown_; ++i) {
      add(plan, type.members_[i], place);
    }
    return plan;
  }
  std::vector<NumberSequence> take_sequences() noexcept { return std::move(sequences_); }
  bool is_at_unknown() const noexcept { return is_at_unknown_; }

private:
  using Step = LengthPlan::Step;
  using Kind = Step::Kind;

  template<typename Member>
  void add(LengthPlan & plan, const Member & member, const Place & place) {
    const bool is_sequence =
      member.is_array_ && (member.array_size_ == 0 || member.is_upper_bound_);
    const size_t count = member.is_array_ ? member.array_size_ : 1;
    if (member.type_id_ == rosidl_typesupport_introspection_c__ROS_TYPE_MESSAGE) {
      const auto & members = *static_cast<const Members *>(member.members_->data);
      const Place inside{
        place.prefix + member.name_ + ".", place.offset + member.offset_,
        place.is_single && !member.is_array_};
      add_messages(plan, LengthPlanner::plan(members, inside), is_sequence, count);
    } else if (const size_t bytes = primitive_bytes(member.type_id_)) {
      const size_t index = is_sequence ? list(member, place) : LengthPlan::not_listed;
      plan.add({Kind::fixed, is_sequence, count, bytes, bytes, nullptr, index});
    } else if (member.type_id_ == rosidl_typesupport_introspection_c__ROS_TYPE_STRING) {
      plan.add({Kind::string, is_sequence, count, 1, length_bytes, nullptr});
    } else if (member.type_id_ == rosidl_typesupport_introspection_c__ROS_TYPE_WSTRING) {
      plan.add({Kind::wide_string, is_sequence, count, 1, length_bytes, nullptr});
    } else {
      is_at_unknown_ = true;
      plan.add({Kind::unknown, is_sequence, 0, 1, 1, nullptr});
    }
  }
  /// Returns the sequence's index.
  template<typename Member>
  size_t list(const Member & member, const Place & place) {
    const char code = typecode(member.type_id_);
    if (code == 0 || !place.is_single) {
      return LengthPlan::not_listed;
    }
    sequences_.push_back({place.prefix + member.name_, code, place.offset + member.offset_});
    return sequences_.size() - 1;
  }
  void add_messages(LengthPlan & plan, LengthPlan part, bool is_sequence, size_t count) {
    const size_t bytes = std::max<size_t>(part.min_bytes(), 1);
    if (part.is_one_block()) {
      plan.add({Kind::fixed, is_sequence, count, part.steps_[0].alignment, bytes, nullptr});
    } else if (is_sequence || count != 1) {
      const Kind kind = is_at_unknown_ ? Kind::unknown : Kind::messages;
      auto shared = std::make_shared<const LengthPlan>(std::move(part));
      plan.add({kind, is_sequence, count, 1, bytes, std::move(shared)});
    } else {
      for (Step & step : part.steps_) {
        plan.add(std::move(step));
      }
    }
  }

  bool is_at_unknown_ = false;
  std::vector<NumberSequence> sequences_;
};

template<typename Members>
LengthPlan LengthPlan::of(const Members & type) {
  LengthPlanner<Members> planner;
  LengthPlan plan = planner.plan(type, {});
  plan.is_whole_ = !planner.is_at_unknown();
  plan.sequences_ = planner.take_sequences();
  plan.find_last_length();
  return plan;
}

template LengthPlan LengthPlan::of(const rosidl_typesupport_introspection_c__MessageMembers &);
template LengthPlan LengthPlan::of(const rosidl_typesupport_introspection_cpp::MessageMembers &);

bool LengthPlan::reserves(const Step & step) {
  return step.is_sequence || step.kind == Step::Kind::wide_string ||
         (step.part != nullptr && step.part->reserves());
}

bool LengthPlan::reserves() const {
  return std::any_of(
    steps_.begin(), steps_.end(), [](const Step & step) { return reserves(step); });
}

size_t LengthPlan::min_bytes() const {
  size_t sum = 0;
  for (const Step & step : steps_) {
    sum += step.is_sequence ? length_bytes : step.count * step.bytes;
  }
  return sum;
}

/// Merges adjacent primitives of equal size into one block.
void LengthPlan::add(Step step) {
  if (step.kind == Step::Kind::fixed && !step.is_sequence) {
    step.bytes *= std::exchange(step.count, 1);
    if (!steps_.empty()) {
      Step & before = steps_.back();
      const bool is_block = before.kind == Step::Kind::fixed && !before.is_sequence;
      if (is_block && before.alignment == step.alignment) {
        before.bytes += step.bytes;
        return;
      }
    }
  }
  steps_.push_back(std::move(step));
}

/// Fast CDR itself checks the lengths of strings, and that enough bytes remain.
void LengthPlan::find_last_length() {
  steps_to_check_ = steps_.size();
  while (steps_to_check_ != 0 && !reserves(steps_[steps_to_check_ - 1])) {
    --steps_to_check_;
  }
  if (steps_to_check_ != 0) {
    const Step & last = steps_[steps_to_check_ - 1];
    ends_with_number_ =
      last.kind != Step::Kind::wide_string && (last.part == nullptr || !last.part->reserves());
  }
}

/// Follows a plan through the CDR of one message. Clears the padding if `Byte` is not const.
template<typename Byte>
class CdrWalk {
public:
  CdrWalk(Byte * data, size_t size, bool swapped) noexcept
  : data_(data), size_(size), swapped_(swapped) {}

  /// Up to the last length.
  bool check(const LengthPlan & plan) {
    for (size_t i = 0; i < plan.steps_to_check_; ++i) {
      const bool is_number = plan.ends_with_number_ && i + 1 == plan.steps_to_check_;
      const Step & step = plan.steps_[i];
      size_t count = step.count;
      if (!number(step, count) || !(is_number || elements(step, count))) {
        return false;
      }
    }
    return true;
  }
  bool follow(const LengthPlan & plan) {
    return std::all_of(plan.steps_.begin(), plan.steps_.end(), [this](const Step & step) {
      size_t count = step.count;
      return number(step, count) && elements(step, count);
    });
  }
  bool has_met_broken_text() const noexcept { return has_met_broken_text_; }
  /// Lets follow() list number sequences of at least `min_bytes`.
  void list_large(std::vector<LengthPlan::Found> & found, size_t min_bytes) noexcept {
    found_ = &found;
    min_bytes_ = min_bytes;
  }

private:
  using Step = LengthPlan::Step;
  static constexpr bool clears = !std::is_const_v<Byte>;

  bool number(const Step & step, size_t & count) noexcept {
    return !step.is_sequence || (length(count) && count <= left() / step.bytes);
  }
  bool elements(const Step & step, size_t count) {
    switch (step.kind) {
      case Step::Kind::fixed:
        return count == 0 || (align(step.alignment) && numbers(step, count));
      case Step::Kind::string:
        return strings(1, count);
      case Step::Kind::wide_string:
        return strings(wide_character_bytes, count);
      case Step::Kind::messages:
        while (count != 0 && follow(*step.part)) {
          --count;
        }
        return count == 0;
      case Step::Kind::unknown:
        break;
    }
    return true;
  }
  bool numbers(const Step & step, size_t count) {
    const size_t at = at_;
    if (!skip(count * step.bytes)) {
      return false;
    }
    if (found_ != nullptr && step.sequence != LengthPlan::not_listed && at_ - at >= min_bytes_) {
      found_->push_back({step.sequence, length_at_, at, count, step.bytes});
    }
    return true;
  }
  bool strings(size_t character_bytes, size_t count) noexcept {
    for (size_t characters = 0; count != 0; --count) {
      if (!length(characters) || !skip(characters * character_bytes)) {
        return false;
      }
      if (!clears && character_bytes == wide_character_bytes && !is_utf16(characters)) {
        has_met_broken_text_ = true;
        return false;
      }
    }
    return true;
  }
  /// Of the characters just skipped. Python would raise, instead of converting, for a surrogate
  /// without its pair. It would swap the bytes of a text that starts with a swapped byte order
  /// mark.
  bool is_utf16(size_t characters) const noexcept {
    const size_t begin = at_ - characters * wide_character_bytes;
    bool is_second_due = false;
    for (size_t i = 0; i < characters; ++i) {
      const uint32_t character = word(begin + i * wide_character_bytes);
      const bool is_second = character >= 0xDC00 && character <= 0xDFFF;
      if (is_second != is_second_due || (i == 0 && character == swapped_byte_order_mark)) {
        return false;
      }
      is_second_due = character >= 0xD800 && character <= 0xDBFF;
    }
    return !is_second_due;
  }

  size_t left() const noexcept { return size_ - at_; }
  bool skip(size_t bytes) noexcept {
    if (bytes > left()) {
      return false;
    }
    at_ += bytes;
    return true;
  }
  bool align(size_t bytes) noexcept {
    const size_t padding = -at_ & (bytes - 1);
    if (!skip(padding)) {
      return false;
    }
    if constexpr (clears) {
      std::fill_n(data_ + at_ - padding, padding, Byte{0});
    }
    return true;
  }
  bool length(size_t & result) noexcept {
    if (!align(length_bytes) || left() < length_bytes) {
      return false;
    }
    result = word(at_);
    length_at_ = at_;
    return skip(length_bytes);
  }
  uint32_t word(size_t at) const noexcept {
    uint32_t value = 0;
    std::memcpy(&value, data_ + at, sizeof(value));
    return swapped_ ? __builtin_bswap32(value) : value;
  }

  Byte * data_;
  size_t size_;
  size_t at_ = 0;
  size_t length_at_ = 0;  ///< of the length read last
  bool swapped_;
  std::vector<LengthPlan::Found> * found_ = nullptr;
  size_t min_bytes_ = 0;
  bool has_met_broken_text_ = false;
};

const char * LengthPlan::find_fault(const uint8_t * data, size_t size, bool swapped) const {
  CdrWalk<const uint8_t> walk(data, size, swapped);
  if (walk.check(*this)) {
    return nullptr;
  }
  return walk.has_met_broken_text() ? "a wide string in it is not UTF-16"
                                    : "a length in it claims more bytes than are left";
}

void LengthPlan::clear_padding(uint8_t * data, size_t size) const {
  CdrWalk<uint8_t>(data, size, false).follow(*this);
}

std::vector<LengthPlan::Found> LengthPlan::find_large(
  const uint8_t * data, size_t size, size_t min_bytes) const {
  std::vector<Found> found;
  if (!sequences_.empty() && size >= min_bytes) {
    CdrWalk<const uint8_t> walk(data, size, false);
    walk.list_large(found, min_bytes);
    walk.follow(*this);
  }
  return found;
}

}  // namespace rmw_manycore
