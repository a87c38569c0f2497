// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>

#include "transport/layout/cluster_layout.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/trace/trace_file.hpp"

namespace manycore {

#ifdef MANYCORE_WITHOUT_TRACE_SITES
constexpr bool has_trace_sites = false;
#else
constexpr bool has_trace_sites = true;
#endif

struct ThreadRing;

/// Records events of this process on one platform while it is traced; see docs/design/trace.md.
/// Thread-safe.
class Tracer {
public:
  /// `registry` and `directory` belong to the platform.
  Tracer(const SharedMemory & registry, std::string directory);
  ~Tracer();
  Tracer(const Tracer &) = delete;
  Tracer & operator=(const Tracer &) = delete;

  /// Makes `by` control tracing of this process; `cluster` is its own cluster.
  void follow(
    const TraceSwitch & by, const TraceIdentity & identity, const ClusterHeader & cluster);
  /// Ends follow(): the memory of `by` may belong to another process afterwards.
  void unfollow() noexcept;

  /// Trace site. Costs two loads while tracing is off.
  void note(
    TraceKind kind, uint32_t endpoint = nothing, uint64_t number = 0, uint64_t value = 0) noexcept {
    if (__builtin_expect(is_on(), 0)) {
      record(kind, endpoint, number, value);
    }
  }
  /// Event without an endpoint: `index` and `step` take the place of slot and incarnation.
  void note_other(
    TraceKind kind, uint32_t index, uint16_t step, uint64_t number, uint64_t value) noexcept;
  bool is_on() const noexcept {
    return has_trace_sites &&
           switch_.load(std::memory_order_relaxed)->load(std::memory_order_relaxed) !=
             TraceScope::off;
  }

private:
  [[gnu::noinline, gnu::cold]] void record(
    TraceKind kind, uint32_t endpoint, uint64_t number, uint64_t value) noexcept;
  /// Ring of the calling thread; nullptr if none is available, which is counted.
  ThreadRing * ring_of_this_thread() noexcept;
  ThreadRing * add_ring() noexcept;
  /// The process's file, created at its first event; nullptr if it cannot be created.
  std::shared_ptr<TraceFile> file() noexcept;
  bool is_wanted(const EndpointEntry & endpoint) const noexcept;
  void describe(TraceFile & file, uint32_t endpoint, uint32_t incarnation) noexcept;
  /// Records CPU time of the process and SMEM use of its cluster.
  void sample(ThreadRing & ring, int64_t time_ns) noexcept;

  RegistryHeader & header() const noexcept { return registry_.at<RegistryHeader>(0); }
  EndpointEntry * endpoint_at(uint32_t slot) const noexcept;

  const ForkSide side_;
  const uint64_t id_;  ///< unique among the tracers of this process
  const SharedMemory & registry_;
  const std::string directory_;
  std::atomic<const TraceSwitch *> switch_;
  std::mutex mutex_;  ///< guards identity_ and file_
  TraceIdentity identity_;
  std::atomic<const ClusterHeader *> cluster_{nullptr};
  std::shared_ptr<TraceFile> file_;
  uint64_t failures_ = 0;
  /// By endpoint slot: incarnation whose name is already in the file.
  std::unique_ptr<std::array<std::atomic<uint32_t>, endpoint_capacity>> described_;
};

}  // namespace manycore
