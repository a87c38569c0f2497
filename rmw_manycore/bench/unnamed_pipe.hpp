// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

#include "platform/pipe.hpp"

namespace manycore::bench {

/// Opens a pipe for this process and its children; its name is gone already.
inline Pipe open_unnamed_pipe() {
  std::string directory = "/tmp/manycore-bench-XXXXXX";
  if (mkdtemp(directory.data()) == nullptr) {
    throw std::system_error(errno, std::generic_category(), "mkdtemp");
  }
  const std::string path = directory + "/pipe";
  Pipe::create(path);
  Pipe pipe = Pipe::open(path);
  unlink(path.c_str());
  rmdir(directory.c_str());
  return pipe;
}

}  // namespace manycore::bench
