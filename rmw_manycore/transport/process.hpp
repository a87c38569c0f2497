// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/layout/endpoint.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/publisher/publisher.hpp"
#include "transport/registry/graph.hpp"
#include "transport/subscription/subscription.hpp"
#include "transport/trace/tracer.hpp"
#include "transport/waiting/waiters.hpp"

namespace manycore {

/// Placement of a process: platform, cluster and core, and its wait mode.
struct Placement {
  std::string platform;
  uint32_t cluster = 1;          ///< from 1
  std::optional<uint32_t> core;  ///< from 0; unset = not pinned and not on any core
  WaitMode wait_mode = WaitMode::block;
  std::string label;  ///< shown by the tools; default: name of the program

  /// Placement in a ROS domain, by default in that of ROS_DOMAIN_ID: the platform "domain-<id>", or
  /// MANYCORE_PLATFORM for that of ROS_DOMAIN_ID, on MANYCORE_CLUSTER and MANYCORE_CORE. These are
  /// places of the named platform: a process beside it joins cluster 1, without a core. Also reads
  /// MANYCORE_WAIT. Throws Error{invalid_argument} naming the variable.
  static Placement from_environment(std::optional<size_t> domain_id = std::nullopt);
  /// Throws Error{invalid_argument} unless such a platform has this cluster and core.
  void require_on(const Profile & profile) const;
};

/// Membership of this process in a platform. Joining creates platform, cluster and receive thread
/// if they are missing; the last process to leave removes everything. Thread-safe.
///
///   const auto process = Process::join(Placement::from_environment());
///   EndpointSpec spec;
///   spec.node = process->add_node("talker", "/", "/");
///   spec.topic = "/chatter";
///   spec.type = "std_msgs/msg/String";
///   const auto publisher = process->create_publisher(spec);
///   Draft draft = publisher->draft(size_bytes);  // room in the topic DSM, to serialize into
///   publisher->publish(std::move(draft), size_bytes, realtime_ns());
///   const auto subscription = process->create_subscription(spec);
///   while (const auto claim = subscription->claim()) {
///     read(claim->data(), claim->size());  // in place, until the claim is destroyed
///   }
class Process {
public:
  /// One membership per process and platform: a second join returns the first membership.
  static std::shared_ptr<Process> join(const Placement & placement);
  ~Process();
  Process(const Process &) = delete;
  Process & operator=(const Process &) = delete;

  /// Returns the handle of the node. Names as in ROS: name "talker", namespace "/" or "/a".
  uint32_t add_node(const std::string & name, const std::string & ns, const std::string & enclave);
  void remove_node(uint32_t node) noexcept;

  /// Throw Error{unsupported|invalid_argument|no_space}. Endpoints must not outlive the Process.
  std::unique_ptr<Publisher> create_publisher(const EndpointSpec & spec);
  std::unique_ptr<Subscription> create_subscription(const EndpointSpec & spec);

  /// True in a child of fork(): operations on this membership fail there or have no effect.
  bool is_inherited() const noexcept;
  /// True once the platform's files were removed from outside.
  bool is_cut_off() const noexcept;
  /// Throws Error{system} in a child of fork(), and after this process was reaped as dead or its
  /// platform was removed.
  void require_membership() const;

  /// Other live processes on the core of this one, except its parent; none without a core.
  std::vector<ProcessInfo> beside() const;

  /// Count the ROS contexts of this process. Once all have ended, the end of the process counts as
  /// intended, whether or not it leaves the platform: tools do not report a death.
  void begin_context() noexcept;
  void end_context() noexcept;
  Waiters & waiters() noexcept;
  Tracer & tracer() noexcept;
  Graph & graph() noexcept;
  const Placement & placement() const noexcept;

private:
  struct Impl;
  explicit Process(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace manycore
