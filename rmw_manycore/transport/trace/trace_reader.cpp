// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/trace/trace_reader.hpp"

#include <algorithm>
#include <cstring>

#include "platform/error.hpp"

namespace manycore {

TraceReader::TraceReader(const std::string & path, uint64_t platform_nonce)
: memory_(SharedMemory::open(path, sizeof(TraceFileHeader))) {
  check_segment(header().segment, trace_magic, memory_.size(), path.c_str());
  if (header().segment.platform_nonce != platform_nonce) {
    refuse("belongs to another platform");
  }
  const uint32_t events_log2 = header().events_log2;
  if (
    events_log2 < min_trace_events_log2 || events_log2 > max_trace_events_log2 ||
    memory_.size() != trace_file_bytes(events_log2)) {
    refuse("is damaged: its size does not match its header");
  }
}

void TraceReader::refuse(const std::string & why) const {
  throw Error(
    ErrorCode::corrupt,
    memory_.path() + " " + why + "; remove it, or run 'manycore clean' once the nodes have ended");
}

uint32_t TraceReader::ring_count() const noexcept {
  return std::min(header().ring_count.load(std::memory_order_acquire), trace_rings_per_process);
}

uint64_t TraceReader::pending() const noexcept {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < ring_count(); ++i) {
    const TraceRing & ring = header().rings[i];
    const uint64_t read = ring.read.load(std::memory_order_relaxed);
    sum += ring.written.load(std::memory_order_acquire) - read;
  }
  return sum;
}

uint64_t TraceReader::lost() const noexcept {
  uint64_t sum = header().unplaced.load(std::memory_order_relaxed) -
                 header().unplaced_saved.load(std::memory_order_relaxed);
  for (uint32_t i = 0; i < ring_count(); ++i) {
    const TraceRing & ring = header().rings[i];
    sum +=
      ring.lost.load(std::memory_order_relaxed) - ring.lost_saved.load(std::memory_order_relaxed);
  }
  return sum;
}

/// Loads `written` (acquire) before the thread's name and events, which the writer stores before
/// it. Loads `lost` before `written`: later losses are reported in the next trace.
ThreadTrace TraceReader::read_ring(uint32_t index) {
  const TraceRing & ring = header().rings[index];
  Position & seen = seen_[index];
  seen.lost = ring.lost.load(std::memory_order_relaxed);
  seen.written = ring.written.load(std::memory_order_acquire);
  const uint64_t read = ring.read.load(std::memory_order_relaxed);
  const uint64_t offset =
    trace_events_offset + uint64_t{index} * (sizeof(TraceEvent) << header().events_log2);
  const uint64_t used = std::min(seen.written, capacity());
  if (seen.written - read > capacity() || (used != 0 && ring.offset != offset)) {
    refuse("is damaged: the positions of a ring are inconsistent");
  }
  ThreadTrace thread;
  thread.tid = ring.tid;
  thread.name.assign(ring.name, strnlen(ring.name, sizeof ring.name));
  thread.lost = seen.lost - ring.lost_saved.load(std::memory_order_relaxed);
  thread.events.reserve(seen.written - read);
  const auto * const events = &memory_.at<TraceEvent>(offset);
  for (uint64_t position = read; position != seen.written; ++position) {
    thread.events.push_back(events[position & (capacity() - 1)]);
  }
  return thread;
}

std::vector<ThreadTrace> TraceReader::read() {
  rings_seen_ = ring_count();
  unplaced_total_ = header().unplaced.load(std::memory_order_relaxed);
  unplaced_ = unplaced_total_ - header().unplaced_saved.load(std::memory_order_relaxed);
  std::vector<ThreadTrace> threads;
  for (uint32_t i = 0; i < rings_seen_; ++i) {
    threads.push_back(read_ring(i));
  }
  return threads;
}

std::vector<TraceName> TraceReader::names() const {
  const uint32_t count =
    std::min(header().name_count.load(std::memory_order_acquire), trace_names_per_process);
  const auto * const first = &memory_.at<TraceName>(trace_names_offset);
  return {first, first + count};
}

void TraceReader::free_read() noexcept {
  header().unplaced_saved.store(unplaced_total_, std::memory_order_relaxed);
  for (uint32_t i = 0; i < rings_seen_; ++i) {
    TraceRing & ring = header().rings[i];
    ring.lost_saved.store(seen_[i].lost, std::memory_order_relaxed);
    // Release: the writer may reuse the space of these events.
    ring.read.store(seen_[i].written, std::memory_order_release);
  }
}

bool TraceReader::is_drained() const noexcept {
  if (ring_count() != rings_seen_ || lost() != 0) {
    return false;
  }
  for (uint32_t i = 0; i < rings_seen_; ++i) {
    if (header().rings[i].written.load(std::memory_order_acquire) != seen_[i].written) {
      return false;
    }
  }
  return true;
}

}  // namespace manycore
