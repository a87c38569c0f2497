// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/worker.hpp"

#include <algorithm>
#include <utility>

#include "platform/clock.hpp"
#include "platform/cpu.hpp"

namespace manycore::ndt {
namespace {

/// Thrown through the optimiser when the job is aborted.
struct Aborted {};

}  // namespace

Worker::Worker(SharedMemory session, uint32_t index)
: memory_(std::move(session)),
  session_(memory_.at<Session>(0)),
  own_(session_.lines[index]),
  index_(index),
  kernel_(kernel_of(choose_simd())) {
  own_.pinned.store(only_cpu() >= 0 ? 1 : 0, std::memory_order_relaxed);
}

void Worker::run() {
  // The coordinator stored the last job's number here before it started this worker.
  uint32_t seen = own_.finished.load(std::memory_order_acquire);
  for (;;) {
    uint32_t job = session_.job.load(std::memory_order_acquire);
    while (job == seen) {
      futex_wait(session_.job, seen, std::nullopt);
      job = session_.job.load(std::memory_order_acquire);
    }
    do_job(job);
    own_.finished.store(job, std::memory_order_seq_cst);
    if (all_finished(job)) {
      announce(session_.end);
    }
    seen = job;
  }
}

/// Of workers that finish a job concurrently, at least one sees all of them finished (seq_cst).
bool Worker::all_finished(uint32_t job) const noexcept {
  for (uint32_t i = 0; i < session_.workers; ++i) {
    if (session_.lines[i].finished.load(std::memory_order_seq_cst) != job) {
      return false;
    }
  }
  return true;
}

void Worker::attach() {
  const Job & what = session_.what;
  attach_maps();
  if (what.scan.id != scan_id_) {
    scan_ = SharedMemory::attach(what.scan.path);
    scan_.populate(0, scan_.size());
    scan_id_ = what.scan.id;
  }
}

/// Keeps maps used by the previous job, and detaches the others.
void Worker::attach_maps() {
  const Job & what = session_.what;
  std::vector<AttachedMap> levels;
  for (uint32_t i = 0; i < what.levels; ++i) {
    const SharedPart & part = what.maps[i];
    const auto kept = std::find_if(
      maps_.begin(), maps_.end(), [&](const AttachedMap & held) { return held.id == part.id; });
    if (kept != maps_.end()) {
      levels.push_back(std::move(*kept));
      maps_.erase(kept);
      continue;
    }
    levels.push_back({part.id, VoxelMap(SharedMemory::attach(part.path))});
    const SharedMemory & memory = levels.back().map.memory();
    memory.populate(0, memory.size());
  }
  maps_ = std::move(levels);
}

void Worker::do_job(uint32_t job) {
  if (session_.what.kind == JobKind::search) {
    search(job);
  } else if (session_.what.levels > 0) {  // 0: a first job, which only checks that all workers run
    align(job);
  }
}

void Worker::search(uint32_t job) {
  const Job & what = session_.what;
  if (!searched_ || searched_->id != what.search.id) {
    searched_.reset();
    searched_ = std::make_unique<AttachedSearch>(what);
  }
  searched_->search.work(what.search_phase, [&] {
    return monotonic_ns() >= what.search_end_ns ||
           session_.aborted.load(std::memory_order_relaxed) == job;
  });
}

void Worker::align(uint32_t job) {
  const Job & what = session_.what;
  searched_.reset();
  attach();
  const int64_t start_ns = monotonic_ns();
  job_ = job;
  pass_ = 0;
  waited_ns_ = 0;
  Descent levels{{}, what.polishing, what.surpassed, what.min_fit};
  for (size_t i = what.first_level; i < what.end_level; ++i) {
    levels.maps.push_back(maps_[i].map.view());
  }
  Problem problem{
    levels.scored(), view_scan(&scan_.at<float>(0), what.points), what.options, std::nullopt};
  if (what.has_regularization) {
    problem.regularization = what.regularization;
  }
  try {
    const auto evaluate = [&](const Problem & level, const Pose6 & pose) {
      const std::optional<TangentSums> sums = pass(level, pose);
      if (!sums) {
        throw Aborted();
      }
      return finish_pass(level, *sums, pose);
    };
    const NewtonResult result = descend(levels, problem, what.guess, evaluate);
    if (index_ == 0) {
      session_.result = result;
    }
  } catch (const Aborted &) {
    return;
  }
  own_.busy_ns.store(
    static_cast<uint64_t>(monotonic_ns() - start_ns - waited_ns_), std::memory_order_relaxed);
}

std::optional<TangentSums> Worker::pass(const Problem & problem, const Pose6 & pose) {
  const PassPose at = pass_pose(pose, *problem.map.header);
  const float d2 = kernel_d2(problem);
  auto & bins = session_.bins[pass_ % 2];
  const uint64_t ticket = ticket_of(job_, ++pass_);
  const int64_t begin_ns = monotonic_ns();
  const uint32_t workers = session_.workers;
  // First the own share, then bins that workers delayed on their CPUs have not begun.
  for (uint32_t i = 0; i < workers; ++i) {
    const uint32_t owner = (index_ + i) % workers;
    while (const auto bin = session_.shares[owner].begin(ticket, owner, workers)) {
      bins[*bin] = kernel_.pass(problem.map, problem.scan, at, d2, *bin);
    }
  }
  log(begin_ns);
  if (!wait_for_all(ticket)) {
    return std::nullopt;
  }
  return add_bins(bins);
}

void Worker::log(int64_t begin_ns) noexcept {
  WorkerLog & log = session_.logs[index_];
  log.passes = pass_;
  if (pass_ <= max_kept_passes) {
    log.kept[pass_ - 1] = {begin_ns, monotonic_ns()};
  }
}

bool Worker::wait_for_all(uint64_t ticket) {
  own_.arrived.store(ticket, std::memory_order_release);
  announce(session_.barrier);
  const auto all_are_here = [&] {
    for (uint32_t i = 0; i < session_.workers; ++i) {
      if (session_.lines[i].arrived.load(std::memory_order_acquire) < ticket) {
        return session_.aborted.load(std::memory_order_acquire) == job_;
      }
    }
    return true;
  };
  const int64_t start_ns = monotonic_ns();
  const int64_t deadline_ns = start_ns + session_.what.spin_ns;
  bool here = all_are_here();
  while (!here && monotonic_ns() < deadline_ns) {
    pause_cpu();
    here = all_are_here();
  }
  if (!here) {
    sleep_until(session_.barrier, all_are_here, std::nullopt);
  }
  waited_ns_ += monotonic_ns() - start_ns;
  return session_.aborted.load(std::memory_order_acquire) != job_;
}

}  // namespace manycore::ndt
