// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/common/error.hpp"

#include <new>

#include "platform/error.hpp"
#include "rmw/error_handling.h"

namespace rmw_manycore {
namespace {

rmw_ret_t code_of(manycore::ErrorCode code) noexcept {
  switch (code) {
    case manycore::ErrorCode::invalid_argument:
      return RMW_RET_INVALID_ARGUMENT;
    case manycore::ErrorCode::unsupported:
      return RMW_RET_UNSUPPORTED;
    case manycore::ErrorCode::timeout:
      return RMW_RET_TIMEOUT;
    default:
      return RMW_RET_ERROR;
  }
}

}  // namespace

void check(rmw_ret_t code) {
  if (code == RMW_RET_OK) {
    return;
  }
  if (!rmw_error_is_set()) {
    RMW_SET_ERROR_MSG(
      code == RMW_RET_BAD_ALLOC ? "out of memory" : "a helper function of rmw has failed");
  }
  throw RmwError(code);
}

rmw_ret_t report_exception() noexcept {
  try {
    throw;
  } catch (const RmwError & error) {
    return error.code();
  } catch (const manycore::Error & error) {
    RMW_SET_ERROR_MSG(error.what());
    return code_of(error.code());
  } catch (const std::bad_alloc &) {
    RMW_SET_ERROR_MSG("out of memory");
    return RMW_RET_BAD_ALLOC;
  } catch (const std::exception & error) {
    RMW_SET_ERROR_MSG(error.what());
    return RMW_RET_ERROR;
  } catch (...) {
    RMW_SET_ERROR_MSG("unknown exception");
    return RMW_RET_ERROR;
  }
}

}  // namespace rmw_manycore
