// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform_of_test.hpp"

#include <dirent.h>
#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/peers/peers.hpp"
#include "transport/registry/smem_charge.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

std::string content_of(const std::string & path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();  // does not throw if the process ends meanwhile
  return content.str();
}

/// Names in a directory that are numbers.
std::vector<std::string> entries_of(const std::string & path) {
  std::vector<std::string> names;
  DIR * const directory = opendir(path.c_str());
  while (const dirent * const entry = directory == nullptr ? nullptr : readdir(directory)) {
    if (std::isdigit(static_cast<unsigned char>(entry->d_name[0]))) {
      names.emplace_back(entry->d_name);
    }
  }
  if (directory != nullptr) {
    closedir(directory);
  }
  return names;
}

/// State and parent of a process or thread from /proc; state 0 if it is gone.
struct Status {
  char state = 0;
  pid_t parent = 0;
};

Status status_of(const std::string & directory) {
  const std::string stat = content_of(directory + "/stat");
  const size_t end_of_name = stat.rfind(')');
  if (end_of_name == std::string::npos) {
    return {};
  }
  return {stat[end_of_name + 2], std::stoi(stat.substr(end_of_name + 4))};
}

template<typename Predicate>
bool any_thread(pid_t pid, Predicate has) {
  const std::string threads = "/proc/" + std::to_string(pid) + "/task/";
  const std::vector<std::string> names = entries_of(threads);
  return std::any_of(names.begin(), names.end(), [&](const std::string & name) {
    const char state = status_of(threads + name).state;
    return state != 0 && has(state);
  });
}

/// True while the parent half of a daemon waits for the child. When it ends, the kernel continues
/// the child if it was stopped before.
bool is_starting(pid_t pid) {
  const pid_t parent = status_of("/proc/" + std::to_string(pid)).parent;
  return content_of("/proc/" + std::to_string(parent) + "/comm").rfind("manycore", 0) == 0;
}

}  // namespace

bool is_asleep(pid_t thread) {
  return status_of("/proc/self/task/" + std::to_string(thread)).state == 'S';
}

bool is_running(pid_t pid) {
  // A killed process holds its locks until its last thread has ended.
  return any_thread(pid, [](char state) { return state != 'Z' && state != 'X'; });
}

bool has_open(pid_t pid, const std::string & file) {
  for (const auto & entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    std::error_code gone;
    if (std::filesystem::read_symlink(entry, gone) == file) {
      return true;
    }
  }
  return false;
}

bool has_pidfds(pid_t pid) { return has_open(pid, "anon_inode:[pidfd]"); }

NoDescriptors::NoDescriptors() {
  getrlimit(RLIMIT_NOFILE, &before_);
  const int lowest_unused = dup(STDIN_FILENO);
  close(lowest_unused);
  const rlimit none{static_cast<rlim_t>(lowest_unused), before_.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
}

NoDescriptors::~NoDescriptors() { setrlimit(RLIMIT_NOFILE, &before_); }

void remove_used(const std::string & directory) {
  wait_until(directory + " is removed", [&] {
    std::error_code changed;  // others were faster, or made another file
    std::filesystem::remove_all(directory, changed);
    return access(directory.c_str(), F_OK) != 0;
  });
}

void stop_process(pid_t pid) {
  kill(pid, SIGSTOP);
  wait_until("process " + std::to_string(pid) + " stands still", [&] {
    return !any_thread(pid, [](char state) { return state != 'T'; });
  });
}

TestPlatform::TestPlatform() {
  static int count = 0;
  name_ = "test-" + std::to_string(getpid()) + "-" + std::to_string(++count);
}

TestPlatform::~TestPlatform() {
  try {
    wait_until(name_ + " to leave nothing", [&] { return !exists() && receive_threads().empty(); });
  } catch (const std::exception & error) {
    FAIL_CHECK(std::string(error.what()), ", directory: ", exists());
    for (const pid_t pid : receive_threads()) {
      kill(pid, SIGKILL);
    }
  }
}

bool TestPlatform::exists() const { return access(paths().directory.c_str(), F_OK) == 0; }

std::shared_ptr<Process> join_platform(const std::string & platform, uint32_t cluster) {
  Placement placement;
  placement.platform = platform;
  placement.cluster = cluster;
  return Process::join(placement);
}

std::shared_ptr<Process> TestPlatform::join(uint32_t cluster, WaitMode mode) const {
  Placement placement;
  placement.platform = name_;
  placement.cluster = cluster;
  placement.wait_mode = mode;
  placement.label = "test";
  return Process::join(placement);
}

std::vector<pid_t> TestPlatform::receive_threads() const {
  std::vector<pid_t> pids;
  for (const std::string & name : entries_of("/proc")) {
    const std::string line = content_of("/proc/" + name + "/cmdline");
    const pid_t pid = std::stoi(name);
    const bool serves = line.find("manycore_receive_thread") != std::string::npos &&
                        line.find('\0' + name_ + '\0') != std::string::npos;
    if (serves && is_running(pid)) {
      pids.push_back(pid);
    }
  }
  return pids;
}

pid_t TestPlatform::receive_thread(uint32_t cluster, pid_t not_this) const {
  Registry registry(paths());
  pid_t pid = 0;
  wait_until("a receive thread in cluster " + std::to_string(cluster), [&] {
    pid = registry.clusters().at(cluster).header().receive_thread_pid.load();
    return pid != 0 && pid != not_this && is_running(pid) && !is_starting(pid) &&
           registry.lifelines().is_held(receive_thread_line + cluster);
  });
  return pid;
}

pid_t TestPlatform::stop_receive_thread(uint32_t cluster) const {
  const pid_t pid = receive_thread(cluster);
  Registry registry(paths());
  while (true) {
    stop_process(pid);
    try {
      const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
      const auto join_lock = FileLock::acquire(paths().join_lock(), 0);
      return pid;
    } catch (const Error &) {
      kill(pid, SIGCONT);
    }
  }
}

Standstill::Standstill(const TestPlatform & platform, uint32_t cluster)
: pid_(platform.stop_receive_thread(cluster)) {}

Standstill::~Standstill() { kill(pid_, SIGCONT); }

Inspection::Inspection(const TestPlatform & platform) : registry_(platform.paths()) {
  try {
    registry_.use_badge_of(process_of(registry_, ProcessIdentity::own()));
  } catch (const Error &) {
    // not a member
  }
}

uint64_t Inspection::resident_bytes(uint32_t cluster) const {
  struct stat status {};
  REQUIRE(stat(registry_.paths().cluster(cluster).c_str(), &status) == 0);
  return static_cast<uint64_t>(status.st_blocks) * 512;
}

uint64_t Inspection::used_bytes(uint32_t cluster) {
  return registry_.clusters().at(cluster).header().used_bytes.load();
}

uint32_t Inspection::live_endpoints() {
  uint32_t count = 0;
  for (uint32_t slot = 0; slot < registry_.endpoints().high_water(); ++slot) {
    count += registry_.endpoints()[slot].slot.state.load() != SlotState::free ? 1 : 0;
  }
  return count;
}

uint32_t Inspection::live_processes() {
  uint32_t count = 0;
  for (uint32_t slot = 0; slot < registry_.processes().high_water(); ++slot) {
    count += registry_.processes().is_live(slot) ? 1 : 0;
  }
  return count;
}

uint32_t Inspection::slot_of(const Gid & gid) {
  for (uint32_t slot = 0; slot < registry_.endpoints().high_water(); ++slot) {
    if (registry_.endpoints().is_live(slot) && registry_.endpoints()[slot].gid == gid) {
      return slot;
    }
  }
  throw std::runtime_error("there is no endpoint with this gid");
}

uint32_t Inspection::generations_of(const Publisher & publisher) {
  uint32_t count = 0;
  for (const GenerationEntry & generation : header_of(publisher).generations) {
    count += generation.first.load() != 0 ? 1 : 0;
  }
  return count;
}

std::vector<Peer> Inspection::readers_of(const Publisher & publisher) {
  Peers peers(registry_, registry_.endpoints()[slot_of(publisher.gid())]);
  peers.refresh();
  return peers.all();
}

TopicDsmHeader & Inspection::header_of(const Publisher & publisher) {
  return *registry_.clusters().find<TopicDsmHeader>(
    registry_.endpoints()[slot_of(publisher.gid())].block);
}

SubscriptionHeader & Inspection::header_of(const Subscription & subscription) {
  return *registry_.clusters().find<SubscriptionHeader>(
    registry_.endpoints()[slot_of(subscription.gid())].block);
}

void Inspection::wait_until_swept(uint32_t left) {
  const auto is_in_hand = [](const Hand & hand) { return hand.block.load() != 0; };
  const Hand * const hands = registry_.header().hands;
  wait_until("the closed endpoints are freed", [&] {
    return closing_endpoints() == left &&
           std::none_of(hands + receive_thread_line + 1, hands + configurator_line, is_in_hand);
  });
  const Registry::Lock lock(registry_);
}
