// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/trace/trace_file.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>

#include "platform/error.hpp"
#include "platform/process_identity.hpp"
#include "transport/layout/registry_layout.hpp"

namespace manycore {
namespace {

/// Backed at a time: 8,192 events. A larger step would delay the traced thread for longer.
constexpr uint64_t step_bytes = 256 << 10;

/// Fraction of the file system that a trace leaves to messages and control blocks: one eighth.
constexpr uint64_t share_left = 8;

uint32_t line_of(const TraceIdentity & identity) {
  return identity.process == nothing ? receive_thread_line + identity.cluster : identity.process;
}

}  // namespace

std::string UnfinishedTrace::path_of(const std::string & path, const TraceIdentity & identity) {
  const size_t name = path.rfind('/') + 1;
  const ProcessIdentity own = ProcessIdentity::own();
  return path.substr(0, name) + "." + path.substr(name) + "." + std::to_string(line_of(identity)) +
         "." + std::to_string(own.pid) + "." + std::to_string(own.start_time);
}

std::optional<UnfinishedTrace> UnfinishedTrace::of(const std::string & name) {
  UnfinishedTrace found{};
  char rest = 0;
  const bool is_one = std::sscanf(
                        name.c_str(), ".trace-%*u.%u.%d.%" SCNu64 "%c", &found.line, &found.pid,
                        &found.start_time, &rest) == 3;
  return is_one && found.line < lifeline_count ? std::optional(found) : std::nullopt;
}

TraceFile::TraceFile(const std::string & path, const TraceIdentity & identity, uint32_t events_log2)
: memory_(
    SharedMemory::create(UnfinishedTrace::path_of(path, identity), trace_file_bytes(events_log2))) {
  try {
    memory_.reserve(0, trace_names_offset);
    describe(identity, events_log2);
    if (rename(memory_.path().c_str(), path.c_str()) != 0) {
      throw_errno("cannot rename " + memory_.path());
    }
  } catch (...) {
    unlink(memory_.path().c_str());
    throw;
  }
}

void TraceFile::describe(const TraceIdentity & identity, uint32_t events_log2) const noexcept {
  TraceFileHeader & head = header();
  head.segment.version = layout_version;
  head.segment.cluster = identity.cluster;
  head.segment.size_bytes = memory_.size();
  head.segment.platform_nonce = identity.platform_nonce;
  head.process = identity.process;
  head.incarnation = identity.incarnation;
  head.pid = getpid();
  head.core = identity.core;
  head.host_cpu = identity.host_cpu;
  head.events_log2 = events_log2;
  std::strncpy(head.label, identity.label.c_str(), sizeof head.label - 1);
  head.segment.magic.store(trace_magic, std::memory_order_release);
}

bool TraceFile::try_back(uint64_t offset, uint64_t length) const noexcept {
  try {
    const FileSystemRoom room = memory_.file_system_room();
    if (room.free_bytes < length + room.total_bytes / share_left) {
      return false;
    }
    memory_.reserve_and_populate(offset, length);
    return true;
  } catch (const std::exception &) {
    return false;
  }
}

uint64_t TraceFile::back(const TraceRing & ring, uint64_t backed) const noexcept {
  const uint64_t capacity = uint64_t{1} << header().events_log2;
  const uint64_t more = std::min(step_bytes / sizeof(TraceEvent), capacity - backed);
  // After a failure, ask for memory again only after this many lost events.
  constexpr uint64_t between_tries = 1024;
  if (
    ring.lost.load(std::memory_order_relaxed) % between_tries != 0 ||
    !try_back(ring.offset + backed * sizeof(TraceEvent), more * sizeof(TraceEvent))) {
    return backed;
  }
  return backed + more;
}

/// An ended ring whose events are saved, or a new one. The saver stores `read` after it has copied
/// the thread's name and events.
TraceRing * TraceFile::free_ring() noexcept {
  TraceFileHeader & head = header();
  const uint32_t count = head.ring_count.load(std::memory_order_relaxed);
  for (uint32_t i = 0; i < count; ++i) {
    TraceRing & ring = head.rings[i];
    if (
      ring.state.load(std::memory_order_acquire) == TraceRingState::ended &&
      ring.read.load(std::memory_order_acquire) == ring.written.load(std::memory_order_relaxed)) {
      return &ring;
    }
  }
  if (count == trace_rings_per_process) {
    return nullptr;
  }
  head.rings[count].offset =
    trace_events_offset + uint64_t{count} * (sizeof(TraceEvent) << head.events_log2);
  return &head.rings[count];
}

std::optional<TraceRingWriter> TraceFile::add_ring() noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  TraceFileHeader & head = header();
  TraceRing * const ring = free_ring();
  if (ring == nullptr) {
    return std::nullopt;
  }
  ring->tid = gettid();
  pthread_getname_np(pthread_self(), ring->name, sizeof ring->name);
  ring->state.store(TraceRingState::used, std::memory_order_release);
  const auto index = static_cast<uint32_t>(ring - head.rings);
  if (index == head.ring_count.load(std::memory_order_relaxed)) {
    head.ring_count.store(index + 1, std::memory_order_release);
  }
  return TraceRingWriter(*ring, &memory_.at<TraceEvent>(ring->offset), head.events_log2);
}

void TraceFile::add_name(const TraceName & name) noexcept {
  const std::lock_guard<std::mutex> lock(mutex_);
  TraceFileHeader & head = header();
  const uint32_t count = head.name_count.load(std::memory_order_relaxed);
  const uint64_t offset = trace_names_offset + uint64_t{count} * sizeof(TraceName);
  if (count == trace_names_per_process || !try_back(offset, sizeof(TraceName))) {
    return;
  }
  memory_.at<TraceName>(offset) = name;
  head.name_count.store(count + 1, std::memory_order_release);
}

}  // namespace manycore
