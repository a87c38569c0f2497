// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform_of_test.hpp"

#include <dirent.h>
#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "patience.hpp"
#include "transport/lifecycle.hpp"
#include "transport/topic_dsm_layout.hpp"

using namespace manycore;

namespace {

std::string content_of(const std::string & path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();  // throws nothing where a process ends meanwhile
  return content.str();
}

}  // namespace

bool is_running(pid_t pid) {
  const std::string stat = content_of("/proc/" + std::to_string(pid) + "/stat");
  const size_t end_of_name = stat.rfind(')');
  return end_of_name != std::string::npos && stat[end_of_name + 2] != 'Z' &&
         stat[end_of_name + 2] != 'X';
}

TestPlatform::TestPlatform() {
  static int count = 0;
  name_ = "test-" + std::to_string(getpid()) + "-" + std::to_string(++count);
}

TestPlatform::~TestPlatform() {
  try {
    wait_until(name_ + " leaves nothing", [&] { return !exists() && receive_threads().empty(); });
  } catch (const std::exception & error) {
    FAIL_CHECK(std::string(error.what()), ", directory: ", exists());
    for (const pid_t pid : receive_threads()) {
      kill(pid, SIGKILL);
    }
  }
}

bool TestPlatform::exists() const { return access(paths().directory.c_str(), F_OK) == 0; }

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
  DIR * const directory = opendir("/proc");
  while (const dirent * const entry = readdir(directory)) {
    const pid_t pid = static_cast<pid_t>(std::atoi(entry->d_name));
    const std::string line =
      pid == 0 ? "" : content_of(std::string("/proc/") + entry->d_name + "/cmdline");
    const bool serves = line.find("manycore_receive_thread") != std::string::npos &&
                        line.find('\0' + name_ + '\0') != std::string::npos;
    if (serves && is_running(pid)) {
      pids.push_back(pid);
    }
  }
  closedir(directory);
  return pids;
}

pid_t TestPlatform::receive_thread(uint32_t cluster, pid_t not_this) const {
  Registry registry(paths());
  pid_t pid = 0;
  wait_until("a receive thread in cluster " + std::to_string(cluster), [&] {
    pid = registry.clusters().at(cluster).header().receive_thread_pid.load();
    return pid != 0 && pid != not_this && is_running(pid) &&
           alive_locks(paths()).is_held(receive_thread_byte + cluster);
  });
  return pid;
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
  auto * const dsm = registry_.clusters().find<TopicDsmHeader>(
    registry_.endpoints()[slot_of(publisher.gid())].block);
  uint32_t count = 0;
  for (const GenerationEntry & generation : dsm->generations) {
    count += generation.first.load() != 0 ? 1 : 0;
  }
  return count;
}
