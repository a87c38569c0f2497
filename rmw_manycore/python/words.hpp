// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <array>
#include <cstddef>
#include <string>

#include "platform/error.hpp"

namespace manycore::python {

/// Maps an enumeration to strings for Python, where it is typed as Literal; files, parameters and
/// JSON use the same strings. A specialisation has `name`, for error texts, and `all`, in the order
/// of the values.
template<typename Enum>
struct Words;

/// Throws Error{corrupt} if a value from shared memory is not in the enumeration.
template<typename Enum>
const char * word_of(Enum value) {
  const auto index = static_cast<size_t>(value);
  if (index >= Words<Enum>::all.size()) {
    throw Error(
      ErrorCode::corrupt, std::string(Words<Enum>::name) + ": unknown value " +
                            std::to_string(index) + " in shared memory");
  }
  return Words<Enum>::all[index];
}

/// Raises ValueError in Python if the enumeration has no such word.
template<typename Enum>
Enum from_word(const std::string & word) {
  constexpr auto & all = Words<Enum>::all;
  std::string expected;
  for (size_t i = 0; i < all.size(); ++i) {
    if (word == all[i]) {
      return static_cast<Enum>(i);
    }
    expected += (i == 0 ? "'" : i + 1 < all.size() ? ", '" : " or '") + std::string(all[i]) + "'";
  }
  const std::string name = Words<Enum>::name;
  throw nanobind::value_error((name + ": expected " + expected + ", found '" + word + "'").c_str());
}

/// Getter for def_prop_ro: an enumeration member of `Class` or of its base class.
template<typename Class, typename Base, typename Enum>
auto word(Enum Base::*member) {
  return [member](const Class & self) { return word_of(self.*member); };
}

}  // namespace manycore::python
