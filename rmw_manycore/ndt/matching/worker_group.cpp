// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "ndt/matching/worker_group.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "platform/clock.hpp"
#include "platform/error.hpp"

namespace manycore::ndt {
namespace {

/// Interval of checking the pidfds while a job runs; a healthy job takes less.
constexpr int64_t look_ns = 10'000'000;
/// A worker that has not reached a barrier for this long, while others wait there, is stopped or
/// stuck. The longest realistic pass, 2 million points by radius in portable code, takes 0.5 s on
/// one core.
constexpr int64_t stuck_ns = 5 * ns_per_s;
/// Workers do not meet in a search, so one that takes long is not yet stuck.
constexpr int64_t longest_search_ns = ns_per_s;
/// Workers on other CPUs reach a barrier within this time unless something is wrong.
constexpr int64_t spin_ns = 200'000;
constexpr int max_attempts = 5;
constexpr size_t first_scan_points = 100'000;

void name_part(SharedPart & part, uint64_t id, const SharedMemory & memory) {
  part.id = id;
  std::strncpy(part.path, memory.shared_path().c_str(), sizeof part.path - 1);
}

size_t scan_bytes(size_t points) {
  return scan_floats(std::max(points, first_scan_points)) * sizeof(float);
}

}  // namespace

WorkerGroup::WorkerGroup(
  const MatchOptions & options, const std::string & program, const std::vector<int> & host_cpus)
: program_(program),
  host_cpus_(host_cpus),
  options_(options),
  memory_(SharedMemory::anonymous("manycore-ndt-session", sizeof(Session))),
  session_(memory_.at<Session>(0)) {
  if (host_cpus.empty() || host_cpus.size() > max_workers) {
    throw Error(
      ErrorCode::invalid_argument, "host_cpus: expected 1 to " + std::to_string(max_workers) +
                                     " CPUs, found " + std::to_string(host_cpus.size()));
  }
  session_.workers = static_cast<uint32_t>(host_cpus.size());
  // Spinning would keep the CPU from workers that share it.
  const bool share = std::set<int>(host_cpus.begin(), host_cpus.end()).size() < host_cpus.size();
  session_.what.spin_ns = share ? 0 : spin_ns;
  workers_.resize(host_cpus.size());
  run_job();
  for (size_t i = 0; i < host_cpus.size(); ++i) {
    if (session_.lines[i].pinned.load(std::memory_order_relaxed) == 0) {
      throw Error(
        ErrorCode::invalid_argument,
        "host CPU " + std::to_string(host_cpus[i]) +
          " is not in this process's affinity mask (see nproc, taskset)");
    }
  }
  put_scan(nullptr, 0);
}

uint64_t WorkerGroup::memory_bytes(size_t points) const noexcept {
  return memory_.size() + std::max<uint64_t>(scan_.size(), scan_bytes(points));
}

void WorkerGroup::put_scan(const float * xyz_m, size_t count) {
  const size_t bytes = scan_bytes(count);
  if (scan_.size() < bytes) {
    scan_ = SharedMemory::anonymous("manycore-ndt-scan", bytes);
    name_part(session_.what.scan, session_.what.scan.id + 1, scan_);
  }
  session_.what.points = lay_out_scan(xyz_m, count, &scan_.at<float>(0)).points;
}

void WorkerGroup::put_levels(const Levels & levels) {
  check_levels(levels);
  Job & what = session_.what;
  what.kind = JobKind::align;
  what.levels = what.end_level = static_cast<uint32_t>(levels.maps.size());
  what.first_level = static_cast<uint32_t>(levels.first);
  what.polishing = static_cast<uint32_t>(levels.polishing);
  what.surpassed = levels.surpassed;
  what.min_fit = levels.min_fit;
  for (size_t i = 0; i < levels.maps.size(); ++i) {
    name_part(what.maps[i], levels.maps[i]->header().id, levels.maps[i]->memory());
  }
}

NewtonResult WorkerGroup::align(
  const Levels & levels, const float * xyz_m, size_t count, const Pose6 & guess,
  const std::optional<Regularization> & regularization) {
  const std::lock_guard lock(busy_);
  Job & what = session_.what;
  put_levels(levels);
  put_scan(xyz_m, count);
  what.options = options_;
  what.guess = guess;
  what.has_regularization = regularization.has_value();
  what.regularization = regularization.value_or(Regularization{});
  run_job();
  return session_.result;
}

Derivatives WorkerGroup::evaluate(
  const Levels & levels, const float * xyz_m, size_t count, const Pose6 & pose) {
  const std::lock_guard lock(busy_);
  Job & what = session_.what;
  put_levels(levels);
  what.end_level = what.levels - what.polishing;
  what.first_level = what.end_level - 1;
  what.polishing = 0;
  put_scan(xyz_m, count);
  what.options = options_;
  what.options.max_iterations = 0;
  what.guess = pose;
  what.has_regularization = false;
  run_job();
  return session_.result.at;
}

bool WorkerGroup::search(PlaceSearch & search, SearchPhase phase, int64_t for_ns) {
  const std::lock_guard lock(busy_);
  Job & what = session_.what;
  what.kind = JobKind::search;
  name_part(what.search_map, search.map().header().id, search.map().memory());
  name_part(what.search, search.head().id, search.memory());
  what.search_phase = phase;
  what.search_end_ns = monotonic_ns() + std::min(for_ns, longest_search_ns);
  // What a killed worker had begun is begun again.
  std::atomic<uint32_t> & next = search.head().next;
  const uint32_t first = next.load(std::memory_order_relaxed);
  run_job([&] { next.store(first, std::memory_order_relaxed); });
  return search.is_done();
}

void WorkerGroup::prepare(const Levels & levels) { evaluate(levels, nullptr, 0, Pose6{}); }

std::vector<int> WorkerGroup::pids() const {
  std::vector<int> out;
  for (const ChildProcess & worker : workers_) {
    out.push_back(worker.pid());
  }
  return out;
}

std::vector<double> WorkerGroup::busy_ns() const {
  std::vector<double> out;
  for (size_t i = 0; i < workers_.size(); ++i) {
    const uint64_t busy_ns = session_.lines[i].busy_ns.load(std::memory_order_relaxed);
    out.push_back(static_cast<double>(busy_ns));
  }
  return out;
}

std::vector<std::vector<WorkerPass>> WorkerGroup::passes() const {
  std::vector<std::vector<WorkerPass>> out;
  for (size_t i = 0; i < workers_.size(); ++i) {
    const WorkerLog & log = session_.logs[i];
    out.emplace_back(log.kept.begin(), log.kept.begin() + std::min(log.passes, max_kept_passes));
  }
  return out;
}

void WorkerGroup::run_job(const std::function<void()> & before_attempt) {
  for (int i = 0; i < max_attempts; ++i) {
    replace_ended_workers();
    before_attempt();
    if (attempt()) {
      return;
    }
  }
  throw Error(
    ErrorCode::system, "the workers ended " + std::to_string(max_attempts) +
                         " times in one alignment: check what kills them (memory limit, signals)");
}

/// One attempt with all workers. False if a worker died; all others are asleep again then.
bool WorkerGroup::attempt() {
  const uint32_t job = session_.job.fetch_add(1, std::memory_order_release) + 1;
  futex_wake_all(session_.job);
  wait_for_workers(job);
  if (all_finished(job) && session_.aborted.load(std::memory_order_relaxed) != job) {
    return true;
  }
  // A dead worker may have been counted.
  session_.barrier.sleepers.store(0, std::memory_order_relaxed);
  return false;
}

void WorkerGroup::wait_for_workers(uint32_t job) {
  uint32_t events = session_.barrier.events.load(std::memory_order_relaxed);
  int64_t quiet_since_ns = monotonic_ns();
  for (;;) {
    const int64_t now_ns = monotonic_ns();
    if (sleep_until(session_.end, [&] { return all_finished(job); }, now_ns + look_ns)) {
      return;
    }
    if (const uint32_t seen = session_.barrier.events.load(std::memory_order_relaxed);
        seen != events) {
      events = seen;
      quiet_since_ns = now_ns;
    } else if (now_ns - quiet_since_ns > stuck_ns) {
      end_stuck_workers(job);
    }
    if (some_worker_ended() && session_.aborted.load(std::memory_order_relaxed) != job) {
      session_.aborted.store(job, std::memory_order_release);
      announce(session_.barrier);
    }
  }
}

/// True if each worker has finished the job, or has died and the job is aborted.
bool WorkerGroup::all_finished(uint32_t job) const noexcept {
  const bool aborted = session_.aborted.load(std::memory_order_acquire) == job;
  for (size_t i = 0; i < workers_.size(); ++i) {
    if (session_.lines[i].finished.load(std::memory_order_acquire) != job) {
      if (!aborted || !workers_[i].has_ended()) {
        return false;
      }
    }
  }
  return true;
}

bool WorkerGroup::some_worker_ended() const noexcept {
  return std::any_of(
    workers_.begin(), workers_.end(), [](const ChildProcess & w) { return w.has_ended(); });
}

void WorkerGroup::end_stuck_workers(uint32_t job) noexcept {
  uint64_t furthest = 0;
  for (size_t i = 0; i < workers_.size(); ++i) {
    furthest = std::max(furthest, session_.lines[i].arrived.load(std::memory_order_relaxed));
  }
  for (size_t i = 0; i < workers_.size(); ++i) {
    const WorkerLine & line = session_.lines[i];
    const bool is_behind =
      job_of(furthest) != job || line.arrived.load(std::memory_order_relaxed) < furthest;
    if (is_behind && line.finished.load(std::memory_order_relaxed) != job) {
      workers_[i].kill();
    }
  }
}

void WorkerGroup::replace_ended_workers() {
  for (uint32_t i = 0; i < workers_.size(); ++i) {
    if (workers_[i].has_ended()) {
      replaced_ += workers_[i].pid() >= 0;
      start_worker(i);
    }
  }
}

void WorkerGroup::start_worker(uint32_t index) {
  session_.lines[index].finished.store(
    session_.job.load(std::memory_order_relaxed), std::memory_order_release);
  workers_[index] = ChildProcess(
    {program_, memory_.shared_path(), std::to_string(index), std::to_string(host_cpus_[index]),
     std::to_string(getpid())});
}

}  // namespace manycore::ndt
