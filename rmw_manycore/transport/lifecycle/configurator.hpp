// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "platform/fork_side.hpp"
#include "transport/lifecycle/lifecycle.hpp"

namespace manycore {

/// Creates a platform before its first node, with profile and topic table from a mapfile, and keeps
/// it during its own lifetime. Used by the launcher.
class Configurator {
public:
  /// Throws Error{invalid_argument} if a platform of this name is running.
  Configurator(
    const std::string & platform, const Profile & profile,
    const std::vector<TopicConfiguration> & topics);
  ~Configurator();
  Configurator(const Configurator &) = delete;
  Configurator & operator=(const Configurator &) = delete;

private:
  ForkSide side_;
  PlatformPaths paths_;
  std::optional<HeldLifeline> lifeline_;
};

/// Names of this user's platforms, running or dead.
std::vector<std::string> platform_names();

/// Opens the registry of a platform to look at it. What appears damaged or dead is looked at again
/// under the join lock: it may be just being created or removed. Throws what Registry() throws, and
/// Error{timeout}.
std::unique_ptr<Registry> look_at(const PlatformPaths & paths);

}  // namespace manycore
