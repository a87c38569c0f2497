// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/configurator.hpp"

#include <algorithm>

#include "platform/error.hpp"
#include "platform/private_directory.hpp"

namespace manycore {
namespace {

constexpr int look_timeout_ms = 2'000;

}  // namespace

Configurator::Configurator(
  const std::string & platform, const Profile & profile,
  const std::vector<TopicConfiguration> & topics)
: paths_(PlatformPaths::of(platform)) {
  under_join_lock(paths_, [&] {
    if (is_alive(paths_)) {
      throw Error(
        ErrorCode::invalid_argument, "platform '" + platform +
                                       "' is running already; stop it, or choose another name "
                                       "('name' under 'platform' in the mapfile)");
    }
    ensure_platform(paths_, profile, topics);
    lifeline_ = Lifelines::open(paths_.alive()).try_hold(configurator_line);
  });
}

Configurator::~Configurator() {
  if (side_.is_inherited()) {
    return;
  }
  try {
    under_join_lock(paths_, [this] {
      lifeline_.reset();
      Registry registry(paths_);
      remove_if_unused(registry);
    });
  } catch (const std::exception &) {
    // Live nodes keep the platform; the last one to leave removes it.
  }
}

std::vector<std::string> platform_names() {
  const auto directory = PrivateDirectory::open(PlatformPaths::of("any").user_directory);
  if (!directory) {
    return {};
  }
  std::vector<std::string> names = directory->directories();
  const auto is_other = [](const std::string & name) { return !PlatformPaths::is_name(name); };
  names.erase(std::remove_if(names.begin(), names.end(), is_other), names.end());
  std::sort(names.begin(), names.end());
  return names;
}

std::unique_ptr<Registry> look_at(const PlatformPaths & paths) {
  try {
    auto registry = std::make_unique<Registry>(paths);
    if (registry->lifelines().is_any_held()) {
      return registry;
    }
  } catch (const Error &) {
    // judged below
  }
  const auto lock = FileLock::acquire_existing(paths.join_lock(), look_timeout_ms);
  return std::make_unique<Registry>(paths);
}

}  // namespace manycore
