// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/process.hpp"
#include "transport/registry/registry.hpp"

/// A platform of its own for one test. At its end nothing may be left: no file, no receive thread.
class TestPlatform {
public:
  TestPlatform();
  ~TestPlatform();

  const std::string & name() const noexcept { return name_; }
  manycore::PlatformPaths paths() const { return manycore::PlatformPaths::of(name_); }
  std::shared_ptr<manycore::Process> join(
    uint32_t cluster = 1, manycore::WaitMode mode = manycore::WaitMode::block) const;
  /// Pids of the receive threads that run for it.
  std::vector<pid_t> receive_threads() const;
  /// Waits until the receive thread of `cluster` serves; its pid. `not_this`: a predecessor.
  pid_t receive_thread(uint32_t cluster, pid_t not_this = 0) const;
  /// Stops it at a moment when it holds neither the registry lock nor the JoinLock; its pid.
  pid_t stop_receive_thread(uint32_t cluster) const;
  bool exists() const;

private:
  std::string name_;
};

/// A receive thread that stands still while this lives, and holds no lock. Where no other process
/// is about, the registry lock is then free for those who wait for it briefly or not at all, and
/// else put off what a test looks for.
class Standstill {
public:
  Standstill(const TestPlatform & platform, uint32_t cluster);
  ~Standstill();
  Standstill(const Standstill &) = delete;
  Standstill & operator=(const Standstill &) = delete;

private:
  pid_t pid_;
};

/// The registry as seen from outside, for looking at what the interface does not show.
class Inspection {
public:
  explicit Inspection(const TestPlatform & platform) : registry_(platform.paths()) {}

  manycore::Registry & registry() noexcept { return registry_; }
  uint64_t used_bytes(uint32_t cluster = 1);
  uint32_t live_endpoints();
  uint32_t live_processes();
  /// Slot of the live endpoint with this gid.
  uint32_t slot_of(const manycore::Gid & gid);
  /// Allocations of a publisher's topic DSM that are in use.
  uint32_t generations_of(const manycore::Publisher & publisher);
  /// Readers on a publisher's reader table.
  uint32_t readers_of(const manycore::Publisher & publisher);
  manycore::SubscriptionHeader & header_of(const manycore::Subscription & subscription);
  /// Endpoints that are gone, and whose memory is not free yet.
  uint32_t closing_endpoints() { return registry_.header().closing_count; }
  /// A reaper that was seen at work has done all it could when this returns.
  void wait_for_reaper();

private:
  manycore::Registry registry_;
};

/// Whether a process runs (a zombie does not).
bool is_running(pid_t pid);

/// True once the watcher of a process sleeps on its receive thread, and opens nothing any more.
bool has_pidfds(pid_t pid);

/// While it lives, this process can open no file.
class NoDescriptors {
public:
  NoDescriptors();
  ~NoDescriptors();
  NoDescriptors(const NoDescriptors &) = delete;
  NoDescriptors & operator=(const NoDescriptors &) = delete;

private:
  rlimit before_{};
};

/// SIGSTOP for a process that is no child; returns once all its threads stand still.
void stop_process(pid_t pid);

/// Code and text of the Error that `act` throws; none when it does not.
struct Refusal {
  std::optional<manycore::ErrorCode> code;
  std::string text;
  bool says(const std::string & part) const { return text.find(part) != std::string::npos; }
};

template<typename Act>
Refusal refusal_of(Act act) {
  try {
    act();
  } catch (const manycore::Error & error) {
    return {error.code(), error.what()};
  }
  return {};
}
