// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/error.hpp"

#include <cerrno>
#include <cstring>

namespace manycore {

void throw_errno(const std::string & what) {
  const int error = errno;
  const auto code = error == EACCES || error == EPERM ? ErrorCode::permission : ErrorCode::system;
  throw Error(code, what + ": " + std::strerror(error));
}

}  // namespace manycore
