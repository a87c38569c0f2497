// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "rmw/ret_types.h"

namespace rmw_manycore {

/// Turns the exception in flight into rmw's error state and the return code that fits it.
rmw_ret_t report_exception() noexcept;

/// The edge of the C interface: no exception of `body` gets past it.
template<typename Body>
rmw_ret_t guarded(Body && body) noexcept {
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    return report_exception();
  }
}

/// For failures while undoing: the error that is being handled matters more.
inline void ignore(rmw_ret_t) noexcept {}

/// The same as guarded for functions that return a handle; nullptr after an exception.
template<typename Body>
auto guarded_handle(Body && body) noexcept -> decltype(body()) {
  try {
    return std::forward<Body>(body)();
  } catch (...) {
    ignore(report_exception());
    return nullptr;
  }
}

/// For calls into rmw's helper library, which report by return code and error state.
class RmwError {
public:
  explicit RmwError(rmw_ret_t code) : code_(code) {}
  rmw_ret_t code() const noexcept { return code_; }

private:
  rmw_ret_t code_;
};

/// Throws RmwError unless `code` is RMW_RET_OK; the error state is set already.
inline void check(rmw_ret_t code) {
  if (code != RMW_RET_OK) {
    throw RmwError(code);
  }
}

}  // namespace rmw_manycore
