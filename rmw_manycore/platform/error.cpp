// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/error.hpp"

#include <cerrno>
#include <cstring>

namespace manycore {
namespace {

const char * advice_for(int error) {
  switch (error) {
    case EMFILE:
      return "; raise this process's limit of open files (ulimit -n)";
    case ENFILE:
      return "; raise the system's limit of open files (sysctl fs.file-max)";
    case ENOMEM:
      return "; raise this process's limit of memory (ulimit -v), or free some";
    default:
      return "";
  }
}

}  // namespace

void throw_errno(const std::string & what) {
  const int error = errno;
  const auto code = error == EACCES || error == EPERM ? ErrorCode::permission : ErrorCode::system;
  throw Error(code, what + ": " + std::strerror(error) + advice_for(error));
}

}  // namespace manycore
