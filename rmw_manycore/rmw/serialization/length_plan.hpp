// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "rmw/serialization/number_sequence.hpp"

namespace rmw_manycore {

constexpr size_t encapsulation_bytes = 4;

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

  const std::vector<NumberSequence> & number_sequences() const noexcept { return sequences_; }
  /// Place of a sequence in a message, in bytes from `data`.
  struct Found {
    size_t index;  ///< in number_sequences()
    size_t length_at;
    size_t at;
    size_t count;
    size_t element_bytes;
  };
  /// The number sequences with elements of `min_bytes` together, in the order of the CDR. `data` is
  /// in this machine's byte order and has no fault. Requires is_whole().
  std::vector<Found> find_large(const uint8_t * data, size_t size, size_t min_bytes) const;

private:
  template<typename Byte>
  friend class CdrWalk;
  template<typename Members>
  friend class LengthPlanner;

  static constexpr size_t not_listed = -1;
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
    size_t sequence = not_listed;  ///< index in number_sequences()
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
  std::vector<NumberSequence> sequences_;
  size_t steps_to_check_ = 0;  ///< no length that reserves memory follows
  /// Of the last one of them only the number of elements is checked.
  bool ends_with_number_ = false;
  bool is_whole_ = false;
};

}  // namespace rmw_manycore
