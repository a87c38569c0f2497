// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ndt/map/voxel_map.hpp"
#include "ndt/matching/worker_session.hpp"
#include "platform/child_process.hpp"
#include "platform/shared_memory.hpp"

namespace manycore::ndt {

/// Matches on worker processes, one per host CPU. The calling thread sleeps meanwhile.
class WorkerGroup {
public:
  /// Starts `program` once per host CPU. Throws Error{invalid_argument} if this process may not use
  /// one of the CPUs.
  WorkerGroup(
    const MatchOptions & options, const std::string & program, const std::vector<int> & host_cpus);

  NewtonResult align(
    const Levels & levels, const float * xyz_m, size_t count, const Pose6 & guess,
    const std::optional<Regularization> & regularization);
  /// Derivatives at a pose, on the scored level.
  Derivatives evaluate(
    const Levels & levels, const float * xyz_m, size_t count, const Pose6 & pose);
  /// Works on a phase of a search for about `for_ns`; true if all of it is done.
  bool search(PlaceSearch & search, SearchPhase phase, int64_t for_ns);
  /// Makes the workers map the levels, so that the next alignment does not have to wait for it.
  void prepare(const Levels & levels);

  std::vector<int> pids() const;
  /// Time in ns that each worker was busy in the last job.
  std::vector<double> busy_ns() const;
  /// Begin and end of each worker's share of each recorded pass of the last job. Must not be called
  /// while a job runs.
  std::vector<std::vector<WorkerPass>> passes() const;
  uint64_t replaced() const noexcept { return replaced_; }
  /// Bytes shared with the workers, without the map, after a scan of `points` points.
  uint64_t memory_bytes(size_t points) const noexcept;

private:
  void put_levels(const Levels & levels);
  void put_scan(const float * xyz_m, size_t count);
  /// Runs a job until no worker dies in it; calls `before_attempt` each time.
  void run_job(const std::function<void()> & before_attempt = [] {});
  bool attempt();
  void wait_for_workers(uint32_t job);
  bool all_finished(uint32_t job) const noexcept;
  bool some_worker_ended() const noexcept;
  void end_stuck_workers(uint32_t job) noexcept;
  void replace_ended_workers();
  void start_worker(uint32_t index);

  std::mutex busy_;
  std::string program_;
  std::vector<int> host_cpus_;
  MatchOptions options_;
  SharedMemory memory_;
  Session & session_;
  SharedMemory scan_;
  std::vector<ChildProcess> workers_;
  uint64_t replaced_ = 0;
};

}  // namespace manycore::ndt
