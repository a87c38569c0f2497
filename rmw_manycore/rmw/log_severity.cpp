// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rcutils/logging.h"
#include "rmw/common/checks.hpp"
#include "rmw/rmw.h"

rmw_ret_t rmw_set_log_severity(rmw_log_severity_t severity) {
  // Invariants
  if (severity < RMW_LOG_SEVERITY_DEBUG || severity > RMW_LOG_SEVERITY_FATAL) {
    RMW_SET_ERROR_MSG_WITH_FORMAT_STRING("unknown log severity %d", static_cast<int>(severity));
    return RMW_RET_ERROR;
  }

  // Implementation
  return rcutils_logging_set_logger_level(rmw_manycore::identifier, severity) == RCUTILS_RET_OK
           ? RMW_RET_OK
           : RMW_RET_ERROR;
}
