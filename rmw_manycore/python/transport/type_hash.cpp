// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "python/transport/type_hash.hpp"

#include <nanobind/nanobind.h>

#include <cstdio>

namespace nb = nanobind;

namespace manycore::python {

std::string to_text(const TypeHash & hash) {
  constexpr char digits[] = "0123456789abcdef";
  char prefix[16];
  std::snprintf(prefix, sizeof prefix, "RIHS%02u_", hash.version);
  std::string text = prefix;
  for (const uint8_t byte : hash.value) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

TypeHash type_hash_from(const std::string & text) {
  TypeHash hash;
  unsigned version = 0;
  int digits = 0;
  const bool prefixed = std::sscanf(text.c_str(), "RIHS%2u_%n", &version, &digits) == 1;
  if (!prefixed || text.size() != digits + 2 * hash.value.size()) {
    throw nb::value_error(
      ("type_hash: expected RIHS01_ and 64 hexadecimal digits, found '" + text + "'").c_str());
  }
  hash.version = static_cast<uint8_t>(version);
  for (uint8_t & byte : hash.value) {
    byte = static_cast<uint8_t>(std::stoi(text.substr(digits, 2), nullptr, 16));
    digits += 2;
  }
  return hash;
}

}  // namespace manycore::python
