// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/peers/peers.hpp"
#include "transport/process.hpp"
#include "transport/registry/registry.hpp"

/// Joins the platform of this name. For roles, to which a test passes only that.
std::shared_ptr<manycore::Process> join_platform(
  const std::string & platform, uint32_t cluster = 1);

/// A platform for one test. Its destructor checks that no file and no receive thread is left.
class TestPlatform {
public:
  TestPlatform();
  ~TestPlatform();

  const std::string & name() const noexcept { return name_; }
  manycore::PlatformPaths paths() const { return manycore::PlatformPaths::of(name_); }
  std::shared_ptr<manycore::Process> join(
    uint32_t cluster = 1, manycore::WaitMode mode = manycore::WaitMode::block) const;
  /// Pids of the platform's receive threads.
  std::vector<pid_t> receive_threads() const;
  /// Waits until the receive thread of `cluster` serves; returns its pid. `not_this` is a
  /// predecessor.
  pid_t receive_thread(uint32_t cluster, pid_t not_this = 0) const;
  /// Stops it while it holds neither the registry lock nor the join lock; returns its pid.
  pid_t stop_receive_thread(uint32_t cluster) const;
  bool exists() const;

private:
  std::string name_;
};

/// Stops a receive thread, which holds no lock, during its lifetime. If no other process is active,
/// operations that try the registry lock briefly or without waiting then succeed; otherwise they
/// would postpone what a test checks.
class Standstill {
public:
  Standstill(const TestPlatform & platform, uint32_t cluster);
  ~Standstill();
  Standstill(const Standstill &) = delete;
  Standstill & operator=(const Standstill &) = delete;

private:
  pid_t pid_;
};

/// The registry seen from outside, to inspect what the interface does not show.
class Inspection {
public:
  /// Takes the registry lock with the badge of this process, if it has joined, and otherwise as a
  /// guest.
  explicit Inspection(const TestPlatform & platform);

  manycore::Registry & registry() noexcept { return registry_; }
  uint64_t used_bytes(uint32_t cluster = 1);
  /// Memory that backs a cluster's segment.
  uint64_t resident_bytes(uint32_t cluster = 1) const;
  uint32_t live_endpoints();
  uint32_t live_processes();
  /// Slot of the live endpoint with this gid.
  uint32_t slot_of(const manycore::Gid & gid);
  /// Number of generations of a publisher's topic DSM that hold memory.
  uint32_t generations_of(const manycore::Publisher & publisher);
  /// The subscriptions that a publisher is matched with.
  std::vector<manycore::Peer> readers_of(const manycore::Publisher & publisher);
  manycore::TopicDsmHeader & header_of(const manycore::Publisher & publisher);
  manycore::SubscriptionHeader & header_of(const manycore::Subscription & subscription);
  /// Endpoints that are closed, but whose memory is not freed yet.
  uint32_t closing_endpoints() { return registry_.header().closing_count; }
  /// Returns once only `left` closed endpoints are not freed, no receive thread has a block in its
  /// hand, and the hold of the registry lock in which that came about is over. A reaper closes and
  /// frees in several holds.
  void wait_until_swept(uint32_t left = 0);

private:
  manycore::Registry registry_;
};

/// True if a process runs; false for a zombie.
bool is_running(pid_t pid);

/// True while a thread of this process sleeps.
bool is_asleep(pid_t thread);

/// True while a process has a descriptor of this file.
bool has_open(pid_t pid, const std::string & file);

/// True once the process's watcher waits on its receive thread, and opens no more files.
bool has_pidfds(pid_t pid);

/// Prevents this process from opening files during its lifetime.
class NoDescriptors {
public:
  NoDescriptors();
  ~NoDescriptors();
  NoDescriptors(const NoDescriptors &) = delete;
  NoDescriptors & operator=(const NoDescriptors &) = delete;

private:
  rlimit before_{};
};

/// Removes a directory in which others make and remove files meanwhile.
void remove_used(const std::string & directory);

/// SIGSTOP for a process that is not a child; returns once all its threads are stopped.
void stop_process(pid_t pid);

/// Code and text of the Error thrown by `act`; empty if it throws none.
struct Refusal {
  std::optional<manycore::ErrorCode> code;
  std::string text;
  bool says(const std::string & part) const { return text.find(part) != std::string::npos; }
};

template<typename Act>
Refusal refusal_of(const Act & act) {
  try {
    act();
  } catch (const manycore::Error & error) {
    return {error.code(), error.what()};
  }
  return {};
}
