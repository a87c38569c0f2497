// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/graph/names_and_types.hpp"

#include <new>

#include "rcpputils/scope_exit.hpp"
#include "rcutils/strdup.h"
#include "rmw/common/error.hpp"
#include "rmw/common/string_array.hpp"

namespace rmw_manycore {
namespace {

rcutils_string_array_t to_array(
  const std::set<std::string> & texts, const rcutils_allocator_t & allocator) {
  StringArray array(texts.size(), allocator);
  size_t i = 0;
  for (const std::string & text : texts) {
    array.set(i++, text.c_str());
  }
  return array.release();
}

}  // namespace

void write(
  const NamesAndTypes & found, rcutils_allocator_t & allocator, rmw_names_and_types_t & result) {
  if (found.empty()) {
    return;
  }
  rmw_names_and_types_t made = rmw_get_zero_initialized_names_and_types();
  check(rmw_names_and_types_init(&made, found.size(), &allocator));
  auto free_made = rcpputils::make_scope_exit([&] { ignore(rmw_names_and_types_fini(&made)); });
  size_t i = 0;
  for (const auto & [name, types] : found) {
    made.names.data[i] = rcutils_strdup(name.c_str(), allocator);
    if (made.names.data[i] == nullptr) {
      throw std::bad_alloc();
    }
    made.types[i] = to_array(types, allocator);
    ++i;
  }
  free_made.cancel();
  result = made;
}

}  // namespace rmw_manycore
