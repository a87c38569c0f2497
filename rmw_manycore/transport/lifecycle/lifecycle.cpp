// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/lifecycle.hpp"

#include <dlfcn.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <exception>

#include "platform/clock.hpp"
#include "platform/os_process.hpp"
#include "platform/private_directory.hpp"
#include "platform/user_directory.hpp"
#include "transport/matching/leaving.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/slots_of_process.hpp"
#include "transport/registry/smem_charge.hpp"

namespace manycore {
namespace {

constexpr int join_timeout_ms = 10'000;

void make_private_directory(const std::string & path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
    throw_errno("cannot create " + path);
  }
  PrivateDirectory::open(path);  // if its last user has just removed it, the caller tries again
}

/// Removes the join lock, and the user directory, if no platform is left. What it cannot remove,
/// the next process that holds the lock tidies up.
void tidy_user_directory(const PlatformPaths & paths) noexcept {
  try {
    const auto directory = PrivateDirectory::open(paths.user_directory);
    const std::vector<std::string> only_lock{PlatformPaths::join_lock_name};
    if (directory && directory->entries() == only_lock) {
      directory->remove(PlatformPaths::join_lock_name);
      if (!paths.is_chosen) {
        rmdir(paths.user_directory.c_str());
      }
    }
  } catch (const std::exception &) {
  }
}

struct UserDirectoryTidier {
  ~UserDirectoryTidier() { tidy_user_directory(paths); }
  const PlatformPaths & paths;
};

bool exists(const std::string & path) { return access(path.c_str(), F_OK) == 0; }

/// Directory of this library, symbolic links resolved.
std::string own_directory() {
  Dl_info info{};
  char resolved[PATH_MAX];
  const auto here = reinterpret_cast<const void *>(&ensure_receive_thread);
  if (dladdr(here, &info) == 0 || realpath(info.dli_fname, resolved) == nullptr) {
    return ".";
  }
  const std::string path = resolved;
  return path.substr(0, path.rfind('/'));
}

/// Searches beside the library in a prefix, in a build tree, and from site-packages up to the
/// prefix.
std::string receive_thread_program() {
  const std::string directory = own_directory();
  for (const char * const place : {"/rmw_manycore/", "/", "/../", "/../../../../rmw_manycore/"}) {
    const std::string candidate = directory + place + "manycore_receive_thread";
    if (access(candidate.c_str(), X_OK) == 0) {
      return candidate;
    }
  }
  throw Error(
    ErrorCode::system,
    "manycore_receive_thread was not found near " + directory + "; reinstall rmw-manycore");
}

/// The caller holds the join lock.
void start_receive_thread(const PlatformPaths & paths, uint32_t cluster) {
  const std::string program = receive_thread_program();
  const int status = spawn_daemon(
    {program, paths.directory.substr(paths.user_directory.size() + 1), std::to_string(cluster)});
  if (status != 0) {
    throw Error(
      ErrorCode::system, "cannot start the receive thread of cluster " + std::to_string(cluster) +
                           " (" + program + ", status " + std::to_string(status) + ")");
  }
}

/// Without the registry lock, a process that is joining may be mistaken for dead.
bool is_dead(Registry & registry, uint32_t process) {
  return registry.processes().is_live(process) && !registry.lifelines().is_held(process);
}

/// Records a death once, even if a reaper dies midway and another reaper repeats its work; a reaper
/// that dies inside this function leaves the death unrecorded. The caller holds the registry lock.
void note_death(Registry & registry, uint32_t process) {
  if (registry.processes()[process].is_ending.exchange(1) != 0) {
    return;
  }
  RegistryHeader & header = registry.header();
  const uint64_t count = header.death_count.load(std::memory_order_relaxed);
  header.deaths[count % kept_deaths] = {registry.processes()[process].pid, process, monotonic_ns()};
  header.death_count.store(count + 1, std::memory_order_release);
}

/// False if another reaper was faster.
bool reap(Registry & registry, uint32_t process) {
  const std::atomic<uint32_t> & incarnation = registry.processes()[process].slot.incarnation;
  const uint32_t first = incarnation.load();
  const auto is_to_reap = [&] {
    return incarnation.load() == first && registry.processes().is_live(process) &&
           !registry.lifelines().is_locked(process);
  };
  {
    // A process that appeared dead without the lock may still join and create endpoints. A process
    // found dead under the lock adds no endpoints or nodes: none of its threads holds the lock.
    const Registry::Lock lock(registry);
    if (!is_to_reap()) {
      return false;
    }
  }
  // Waits until the last thread of the process has ended. This takes system calls, so it is done
  // without the lock.
  if (registry.lifelines().is_held(process)) {
    return false;
  }
  if (!close_endpoints_of(registry, process, true, is_to_reap)) {
    return false;
  }
  empty_hand_of_dead(registry, process);
  const Registry::Lock lock(registry);
  if (!is_to_reap()) {
    return false;
  }
  remove_nodes_of(registry, process);
  note_death(registry, process);
  leave_registry(registry, process);
  return true;
}

}  // namespace

void under_join_lock(const PlatformPaths & paths, const std::function<void()> & act) {
  const auto act_and_tidy_up = [&] {
    const UserDirectoryTidier tidier{paths};
    act();
  };
  do {
    if (!paths.is_chosen) {
      make_private_directory(paths.user_directory);
    }
    if (FileLock::run(paths.join_lock(), join_timeout_ms, act_and_tidy_up)) {
      return;
    }
  } while (!paths.is_chosen);  // its last user may have removed it
  throw Error(
    ErrorCode::system, "MANYCORE_DIRECTORY='" + paths.user_directory +
                         "' was removed, and its platforms with it; create it again");
}

/// SMEM of each cluster in bytes, in whole MiB, on a machine with `shared_bytes` of shared memory
/// (0 = no limit): an equal share of half of it. On a small machine clusters may overcommit and use
/// what the others leave.
uint64_t host_smem_bytes(uint64_t shared_bytes, uint32_t clusters) {
  constexpr uint64_t mebibyte = 1u << 20;
  constexpr uint64_t useful = 1024 * mebibyte;
  const uint64_t share = shared_bytes / 2 / clusters;
  const uint64_t common = shared_bytes == 0 ? useful : std::min(shared_bytes / 4 * 3, useful);
  return std::max({share, common, mebibyte}) / mebibyte * mebibyte;
}

Profile host_profile() {
  Profile profile{};
  profile.clusters = 5;
  profile.cores_per_cluster = 16;
  struct statvfs fs {};
  statvfs(UserDirectory::from_environment().place().c_str(), &fs);
  profile.smem_bytes = host_smem_bytes(uint64_t{fs.f_blocks} * fs.f_frsize, profile.clusters);
  std::fill_n(profile.host_cpu_of_receive_thread, max_clusters, -1);
  std::fill_n(profile.numa_node, max_clusters, -1);
  return profile;
}

bool is_alive(const PlatformPaths & paths) {
  return exists(paths.alive()) && Lifelines::open(paths.alive()).is_any_held();
}

void ensure_platform(
  const PlatformPaths & paths, const Profile & profile,
  const std::vector<TopicConfiguration> & topics) {
  if (exists(paths.directory) && !is_alive(paths)) {
    remove_platform(paths);
  }
  if (!exists(paths.directory)) {
    make_private_directory(paths.directory);
    try {
      if (paths.is_chosen) {
        require_file_system_features(paths.directory);
      }
      Lifelines::create(paths.alive(), lifeline_count);
      Registry::create(paths, profile, topics);
    } catch (...) {
      remove_platform(paths);
      throw;
    }
  }
}

std::vector<std::string> remove_platform(const PlatformPaths & paths) {
  const auto directory = PrivateDirectory::open(paths.directory);
  if (!directory) {
    return {};
  }
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if (exists(paths.pipe(id))) {
      EmcosMessage message{};
      message.kind = EmcosMessageKind::detach;
      try {
        Pipe::open(paths.pipe(id)).send_last(&message, sizeof message);
      } catch (const Error &) {
        // no longer a pipe, so no receive thread reads it
      }
    }
  }
  std::vector<std::string> removed;
  for (const std::string & name : directory->entries()) {
    if (directory->remove(name)) {
      removed.push_back(paths.directory + "/" + name);
    }
  }
  rmdir(paths.directory.c_str());
  return removed;
}

bool is_in_use(Registry & registry) {
  const Lifelines & alive = registry.lifelines();
  if (alive.is_held(configurator_line)) {
    return true;
  }
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (registry.processes().is_live(slot) && alive.is_held(slot)) {
      return true;
    }
  }
  return false;
}

/// Records the deaths that no reaper has recorded yet: of two that reap one process, the second
/// may remove the platform while the first is midway.
void note_all_deaths(Registry & registry) {
  try {
    const Registry::Lock lock(registry, Registry::Lock::short_wait_ns);
    for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
      if (is_dead(registry, slot)) {
        note_death(registry, slot);
      }
    }
  } catch (const Error &) {
    // damaged, or held by a stopped process: nothing of the platform stays
  }
}

bool remove_if_unused(Registry & registry) {
  const PlatformPaths & paths = registry.paths();
  // Without lifelines no process can join: the other files are of no use to those that still run.
  if (
    exists(paths.alive()) &&
    (!registry.lifelines().is_file(paths.alive()) || is_in_use(registry))) {
    return false;
  }
  note_all_deaths(registry);
  remove_platform(paths);
  return true;
}

void note_removal(Registry & registry) noexcept {
  registry.header().removed.store(1, std::memory_order_seq_cst);
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (registry.processes().is_live(slot)) {
      registry.processes()[slot].wake.notify_all();
    }
  }
}

void empty_hands_of_receive_threads(Registry & registry) {
  for (uint32_t line = receive_thread_line + 1; line < configurator_line; ++line) {
    if (registry.header().hands[line].block.load() != 0 && !registry.lifelines().is_held(line)) {
      empty_hand_of_dead(registry, line);
    }
  }
}

void remove_nodes_of(Registry & registry, uint32_t process) {
  for (const uint32_t slot : slots_of_process(registry.nodes(), process)) {
    registry.nodes().give_back(slot);
  }
}

void leave_registry(Registry & registry, uint32_t process) {
  discharge(registry, process);
  registry.header().graph_watchers.remove(process);
  registry.processes().give_back(process);
}

uint32_t reap_dead(Registry & registry, uint32_t cluster) {
  uint32_t dead = 0;
  for (const bool own : {true, false}) {
    for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
      // Check without the lock first: the check waits until the last thread of the dead process has
      // ended.
      if (
        (registry.processes()[slot].cluster == cluster) == own && is_dead(registry, slot) &&
        reap(registry, slot)) {
        ++dead;
      }
    }
  }
  return dead;
}

void notify_other_reapers(Registry & registry, uint32_t own) {
  const uint64_t present = registry.header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    Cluster * const cluster =
      (present >> (id - 1) & 1) != 0 && id != own ? registry.clusters().find(id) : nullptr;
    if (cluster != nullptr) {
      cluster->wake_reaper();
    }
  }
}

void ensure_receive_thread(const Registry & registry, uint32_t cluster) {
  const uint32_t line = receive_thread_line + cluster;
  if (registry.lifelines().is_held(line)) {
    return;
  }
  const PlatformPaths & paths = registry.paths();
  // one starter at a time
  under_join_lock(paths, [&] {
    if (registry.is_current() && !registry.lifelines().is_held(line)) {
      start_receive_thread(paths, cluster);
    }
  });
}

}  // namespace manycore
