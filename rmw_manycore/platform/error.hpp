// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace manycore {

/// What went wrong, coarse enough for a caller to choose its answer.
enum class ErrorCode {
  invalid_argument,  ///< the caller asked for something that has no meaning
  unsupported,       ///< a QoS or feature that is not honoured (never accepted silently)
  no_space,          ///< the cluster's SMEM, /dev/shm or a table is full
  too_large,         ///< a message that cannot fit its topic DSM
  timeout,           ///< a bound was reached (registry lock, RELIABLE + KEEP_ALL publish)
  corrupt,           ///< a segment or pipe that is truncated, foreign or of another layout
  permission,        ///< not ours to open
  system,            ///< any other operating-system error
};

/// The one exception of the transport; its text says what to do.
class Error : public std::runtime_error {
public:
  Error(ErrorCode code, const std::string & what) : std::runtime_error(what), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

private:
  ErrorCode code_;
};

/// Throws Error{system or permission} with errno's text and, at a limit, how to raise it.
[[noreturn]] void throw_errno(const std::string & what);

}  // namespace manycore
