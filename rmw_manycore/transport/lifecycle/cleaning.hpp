// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "platform/error.hpp"

namespace manycore {

/// The platform has living processes.
class PlatformInUse : public Error {
public:
  explicit PlatformInUse(const std::string & what) : Error(ErrorCode::invalid_argument, what) {}
};

/// Removes the files of a dead platform, whatever their state, and returns their paths. Ends
/// receive threads that are left without processes.
///
/// Lifelines prove which processes live. Where they are damaged, or with `force` not believed,
/// a process counts as living if it is visible here and maps a file of the platform.
///
/// Throws PlatformInUse, and Error{system} if files cannot be removed.
std::vector<std::string> clean_platform(const std::string & platform, bool force = false);

}  // namespace manycore
