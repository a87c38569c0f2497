// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rmw_manycore {

/// Positions of the lengths in the CDR of a type's messages, computed once per type. Members of
/// fixed size in between are skipped in one step, and nothing is checked after the last length.
class LengthPlan {
public:
  /// `Members` describes the fields of a type by introspection, in C or C++.
  template<typename Members>
  static LengthPlan of(const Members & type);

  /// False if a length claims more elements or characters than the remaining bytes can hold. `data`
  /// starts after the encapsulation header; `swapped` means the opposite byte order.
  bool fits(const uint8_t * data, size_t size, bool swapped) const;

private:
  friend class LengthWalk;
  template<typename Members>
  friend class LengthPlanner;

  struct Step {
    enum class Kind : uint8_t {
      fixed,        ///< `bytes` of primitives, aligned
      string,       ///< length, characters
      wide_string,  ///< length, characters of four bytes
      messages,     ///< nested messages, described by `part`
      passed_over,  ///< only their number is checked: no length that reserves memory follows
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
  void end_at_last_length();

  std::vector<Step> steps_;
};

}  // namespace rmw_manycore
