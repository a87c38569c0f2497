// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/configurator.hpp"

#include <dirent.h>

#include <algorithm>
#include <cerrno>

#include "platform/error.hpp"

namespace manycore {

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
  const std::string directory = PlatformPaths::of("any").user_directory;
  std::vector<std::string> names;
  DIR * const handle = opendir(directory.c_str());
  if (!handle) {
    if (errno != ENOENT) {
      throw_errno("cannot list " + directory);
    }
    return names;
  }
  while (const dirent * const entry = readdir(handle)) {
    if (entry->d_type == DT_DIR && PlatformPaths::is_name(entry->d_name)) {
      names.emplace_back(entry->d_name);
    }
  }
  closedir(handle);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace manycore
