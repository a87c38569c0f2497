// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "rmw/ret_types.h"

namespace rmw_manycore {

/// Translates the current exception into rmw's error state and a matching return code.
rmw_ret_t report_exception() noexcept;

/// Boundary of the C interface: no exception of `body` crosses it.
template<typename Body>
rmw_ret_t guarded(Body && body) noexcept {
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    return report_exception();
  }
}

/// Ignores a failure during cleanup: the error already being handled matters more.
inline void ignore(rmw_ret_t) noexcept {}

/// As guarded(), for functions that return a handle; returns nullptr after an exception.
template<typename Body>
auto guarded_handle(Body && body) noexcept -> decltype(body()) {
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    ignore(report_exception());
    return nullptr;
  }
}

/// Failure of a function of rmw's helper library. The error state is set.
class RmwError {
public:
  explicit RmwError(rmw_ret_t code) : code_(code) {}
  rmw_ret_t code() const noexcept { return code_; }

private:
  rmw_ret_t code_;
};

/// Throws RmwError unless `code` is RMW_RET_OK. Sets the error state if the helper library has not,
/// as after some failed allocations.
void check(rmw_ret_t code);

}  // namespace rmw_manycore
