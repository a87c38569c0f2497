// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace manycore {

/// Kind of an error, for callers that react to it.
enum class ErrorCode {
  invalid_argument,  ///< an argument without meaning
  unsupported,       ///< a QoS or feature that is not supported; never accepted silently
  no_space,          ///< the cluster's SMEM, its file system or a table is full
  too_large,         ///< a message larger than its topic DSM can be
  timeout,           ///< a time limit was reached (registry lock, RELIABLE + KEEP_ALL publish)
  corrupt,           ///< a segment or pipe is damaged, foreign or of another layout
  permission,        ///< access is denied, or an object is not private to this user
  system,            ///< any other operating-system error
};

/// The exception of all layers below rmw. Its text names the cure.
class Error : public std::runtime_error {
public:
  Error(ErrorCode code, const std::string & what) : std::runtime_error(what), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

private:
  ErrorCode code_;
};

/// Throws Error{system|permission} with the text of errno and, at a resource limit, how to raise
/// it.
[[noreturn]] void throw_errno(const std::string & what);

}  // namespace manycore
