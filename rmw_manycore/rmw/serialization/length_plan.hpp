// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rmw_manycore {

/// Positions of the lengths and of the padding in the CDR of a type's messages, computed once per
/// type. Members of fixed size in between are skipped in one step.
class LengthPlan {
public:
  /// `Members` describes the fields of a type by introspection, in C or C++.
  template<typename Members>
  static LengthPlan of(const Members & type);

  /// What is wrong, or null: a length claims more elements or characters than the remaining bytes
  /// can hold, or a wide string is not UTF-16. `data` starts after the encapsulation header;
  /// `swapped` means the opposite byte order. Does not look beyond the last length.
  const char * find_fault(const uint8_t * data, size_t size, bool swapped) const;

  /// True if the positions of all members are known.
  bool is_whole() const noexcept { return is_whole_; }
  /// Clears the padding of a message in this machine's byte order. Requires is_whole().
  void clear_padding(uint8_t * data, size_t size) const;

private:
  template<typename Byte>
  friend class CdrWalk;
  template<typename Members>
  friend class LengthPlanner;

  struct Step {
    enum class Kind : uint8_t {
      fixed,        ///< `bytes` of primitives, aligned
      string,       ///< length, characters
      wide_string,  ///< length, characters of four bytes
      messages,     ///< nested messages, described by `part`
      unknown,      ///< of unknown size, as is what follows
    };
    Kind kind;
    bool is_sequence;  ///< the number of elements is in the CDR
    size_t count;      ///< number of elements, unless is_sequence
    size_t alignment;
    size_t bytes;  ///< minimum size of an element
    std::shared_ptr<const LengthPlan> part;
  };

  /// True if the step contains a length for which memory is reserved before the elements are read.
  static bool reserves(const Step & step);
  bool reserves() const;
  size_t min_bytes() const;
  /// True for a message of equal-sized primitives, which has no padding, not even in sequences.
  bool is_one_block() const {
    return steps_.size() == 1 && steps_[0].kind == Step::Kind::fixed && !steps_[0].is_sequence;
  }
  void add(Step step);
  void find_last_length();

  std::vector<Step> steps_;
  size_t steps_to_check_ = 0;  ///< no length that reserves memory follows
  /// Of the last one of them only the number of elements is checked.
  bool ends_with_number_ = false;
  bool is_whole_ = false;
};

}  // namespace rmw_manycore
