// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace rmw_manycore {

/// Where in the CDR of a type's messages lengths stand, made once for the type: what has a fixed
/// size between them is passed over in one step, and nothing is looked at behind the last one.
class LengthPlan {
public:
  /// `Members` describes the fields of a type, as introspection in C or in C++ does.
  template<typename Members>
  static LengthPlan of(const Members & type);

  /// False when a length claims more elements or characters than the bytes left can hold. `data`
  /// starts behind the encapsulation header; `swapped`: it is in the other byte order.
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
      messages,     ///< as in `part`
      passed_over,  ///< only their number matters: no length follows that memory is reserved by
    };
    Kind kind;
    bool is_sequence;  ///< the number of elements is in the CDR
    size_t count;      ///< of elements, unless it is
    size_t alignment;
    size_t bytes;  ///< of an element, at least
    std::shared_ptr<const LengthPlan> part;
  };

  /// Memory is reserved by a length in it before the elements are read.
  static bool reserves(const Step & step);
  bool reserves() const;
  size_t least_bytes() const;
  /// A message of primitives of one size has no padding, also in sequences.
  bool is_one_block() const {
    return steps_.size() == 1 && steps_[0].kind == Step::Kind::fixed && !steps_[0].is_sequence;
  }
  void add(Step step);
  void end_at_last_length();

  std::vector<Step> steps_;
};

}  // namespace rmw_manycore
