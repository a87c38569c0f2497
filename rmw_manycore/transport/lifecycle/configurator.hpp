// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "platform/fork_side.hpp"
#include "transport/lifecycle/lifecycle.hpp"

namespace manycore {

/// Creates a platform before its first node, and keeps it while alive: profile and topic table come
/// from a mapfile. For the launcher.
class Configurator {
public:
  /// Throws Error{invalid_argument} when a platform of this name is alive already.
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

/// Names of this user's platforms, dead or alive.
std::vector<std::string> platform_names();

/// Removes what a dead platform left. Throws Error{invalid_argument} when it is alive. Returns the
/// paths.
std::vector<std::string> clean_platform(const std::string & platform);

}  // namespace manycore
