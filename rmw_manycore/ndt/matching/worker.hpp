// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ndt/map/voxel_map.hpp"
#include "ndt/matching/worker_session.hpp"
#include "platform/shared_memory.hpp"

namespace manycore::ndt {

/// Main loop of a worker process: sleeps until there is a job, then computes its share of the bins
/// of each pass, in step with the other workers. Each worker sums all bins and takes Newton's step
/// itself: the same numbers in the same order yield the same pose, so one barrier per pass
/// suffices.
class Worker {
public:
  Worker(SharedMemory session, uint32_t index);
  [[noreturn]] void run();

private:
  struct AttachedMap {
    uint64_t id;
    VoxelMap map;
  };

  /// A search that this worker takes part in, until its next alignment.
  struct AttachedSearch {
    explicit AttachedSearch(const Job & what)
    : id(what.search.id),
      map(SharedMemory::attach(what.search_map.path)),
      search(map, SharedMemory::attach(what.search.path)) {}

    uint64_t id;
    SearchMap map;
    PlaceSearch search;
  };

  bool all_finished(uint32_t job) const noexcept;
  void attach();
  void attach_maps();
  void do_job(uint32_t job);
  void align(uint32_t job);
  void search(uint32_t job);
  /// Sums of all bins at a pose; empty if the job is aborted.
  std::optional<TangentSums> pass(const Problem & problem, const Pose6 & pose);
  /// Records begin and end of the share of the current pass.
  void log(int64_t begin_ns) noexcept;
  bool wait_for_all(uint64_t ticket);

  SharedMemory memory_;
  Session & session_;
  WorkerLine & own_;
  uint32_t index_;
  Kernel kernel_;
  std::vector<AttachedMap> maps_;  ///< levels of the last job
  std::unique_ptr<AttachedSearch> searched_;
  SharedMemory scan_;
  uint64_t scan_id_ = 0;
  uint32_t job_ = 0;
  uint32_t pass_ = 0;
  int64_t waited_ns_ = 0;
};

}  // namespace manycore::ndt
