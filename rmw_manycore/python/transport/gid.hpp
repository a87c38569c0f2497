// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <string>

#include "transport/layout/endpoint.hpp"

namespace manycore::python {

/// A gid as 16 bytes in Python.
inline nanobind::bytes to_bytes(const Gid & gid) { return nanobind::bytes(gid.data(), gid.size()); }

/// Raises ValueError in Python, with the name of the argument, if `bytes` is no gid.
inline Gid gid_from(const nanobind::bytes & bytes, const std::string & argument) {
  Gid gid{};
  if (bytes.size() != gid.size()) {
    throw nanobind::value_error((argument + ": expected the 16 bytes of a gid").c_str());
  }
  std::copy_n(static_cast<const uint8_t *>(bytes.data()), gid.size(), gid.begin());
  return gid;
}

}  // namespace manycore::python
