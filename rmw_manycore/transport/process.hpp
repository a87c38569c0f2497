// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "transport/layout/endpoint.hpp"
#include "transport/publisher/publisher.hpp"
#include "transport/registry/graph.hpp"
#include "transport/subscription/subscription.hpp"
#include "transport/trace/tracer.hpp"
#include "transport/waiting/waiters.hpp"

namespace manycore {

/// Where a process runs: platform, virtual cluster and core, and how it waits.
struct Placement {
  std::string platform;
  uint32_t cluster = 1;          ///< from 1
  std::optional<uint32_t> core;  ///< from 0; unset = not pinned, shares no virtual core
  WaitMode wait_mode = WaitMode::block;
  std::string label;  ///< shown by the tools; default: the program's name

  /// From MANYCORE_PLATFORM, MANYCORE_CLUSTER, MANYCORE_CORE, MANYCORE_WAIT; platform defaults to
  /// "domain-<domain_id>". Throws Error{invalid_argument} naming the variable.
  static Placement from_environment(size_t domain_id);
};

/// This process's membership of a platform. Joining brings up platform, cluster and receive thread
/// where they are missing; the last one to leave removes everything. Thread-safe.
class Process {
public:
  /// One membership per (process, platform): a second join returns the first one.
  static std::shared_ptr<Process> join(const Placement & placement);
  ~Process();
  Process(const Process &) = delete;
  Process & operator=(const Process &) = delete;

  /// Returns the node's handle. Names as in ROS: name "talker", namespace "/" or "/a".
  uint32_t add_node(const std::string & name, const std::string & ns, const std::string & enclave);
  void remove_node(uint32_t node) noexcept;

  /// Throw Error{unsupported|invalid_argument|no_space}. Endpoints must not outlive the Process.
  std::unique_ptr<Publisher> create_publisher(const EndpointSpec & spec);
  std::unique_ptr<Subscription> create_subscription(const EndpointSpec & spec);

  /// True in a child of fork(): what belongs to this membership fails there, or does nothing.
  bool is_inherited() const noexcept;
  /// True once the platform's files were removed from outside.
  bool is_cut_off() const noexcept;
  /// Throws Error{system} in a child of fork(), and once this process was taken for dead or cut
  /// off.
  void require_membership() const;

  /// Counts the contexts of this process. Once all that began have ended, the end of the process
  /// is intended, whether or not it leaves: tools do not show it as a death.
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
