// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/trace/tracer.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "platform/clock.hpp"
#include "platform/error.hpp"

namespace manycore {
namespace {

constexpr TraceSwitch never{TraceScope::off};

/// A thread's rings, one for each platform it serves.
class ThreadRings {
public:
  struct Ring {
    uint64_t tracer;
    std::shared_ptr<TraceFile> file;  ///< keeps the memory while the thread lives
    TraceRingWriter writer;
  };

  ~ThreadRings() {
    for (Ring & ring : rings_) {
      end(ring);
    }
  }

  Ring * find(uint64_t tracer) noexcept {
    if (last_ != nullptr && last_->tracer == tracer) {
      return last_;
    }
    const auto found = std::find_if(
      rings_.begin(), rings_.end(), [&](const Ring & ring) { return ring.tracer == tracer; });
    last_ = found == rings_.end() ? nullptr : &*found;
    return last_;
  }

  Ring * add(Ring && fresh) {
    last_ = nullptr;
    // Those of platforms that the process has left.
    const auto gone = std::remove_if(
      rings_.begin(), rings_.end(), [](const Ring & ring) { return ring.file.use_count() == 1; });
    std::for_each(gone, rings_.end(), end);
    rings_.erase(gone, rings_.end());
    rings_.push_back(std::move(fresh));
    last_ = &rings_.back();
    return last_;
  }

private:
  static void end(Ring & ring) noexcept {
    if (ring.file != nullptr && !ring.file->is_inherited()) {
      ring.writer.ring().state.store(TraceRingState::ended, std::memory_order_release);
    }
  }

  std::vector<Ring> rings_;
  Ring * last_ = nullptr;
};

thread_local ThreadRings thread_rings;

uint64_t next_id() noexcept {
  static std::atomic<uint64_t> last{0};
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

template<size_t size>
void copy_text(char (&to)[size], const std::string & text) noexcept {
  std::memset(to, 0, size);
  std::memcpy(to, text.data(), std::min(text.size(), size - 1));
}

template<size_t size>
std::string text_in(const char (&field)[size]) {
  return {field, strnlen(field, size)};
}

}  // namespace

Tracer::Tracer(const SharedMemory & registry, std::string directory)
: id_(next_id()), registry_(registry), directory_(std::move(directory)), switch_(&never) {}

Tracer::~Tracer() = default;

void Tracer::follow(const TraceSwitch & by, const TraceIdentity & identity) {
  const std::lock_guard<std::mutex> lock(mutex_);
  identity_ = identity;
  identity_.platform_nonce = header().segment.platform_nonce;
  switch_.store(&by, std::memory_order_relaxed);
}

void Tracer::unfollow() noexcept { switch_.store(&never, std::memory_order_relaxed); }

EndpointEntry * Tracer::endpoint_at(uint32_t slot) const noexcept {
  const uint32_t count = header().endpoints.high_water.load(std::memory_order_acquire);
  return slot < count && slot < endpoint_capacity
           ? &registry_.at<EndpointEntry>(
               endpoint_table_offset + uint64_t{slot} * sizeof(EndpointEntry))
           : nullptr;
}

void Tracer::record(TraceKind kind, uint32_t endpoint, uint64_t number, uint64_t value) noexcept {
  if (side_.is_inherited()) {
    return;
  }
  TraceEvent event{monotonic_ns(), number, value, endpoint, 0, kind};
  TraceRingWriter * const ring = ring_of_this_thread();
  if (ring == nullptr) {
    return;
  }
  if (const EndpointEntry * const entry = endpoint_at(endpoint)) {
    if (!is_wanted(*entry)) {
      return;
    }
    const uint32_t incarnation = entry->slot.incarnation.load(std::memory_order_relaxed);
    event.incarnation = static_cast<uint16_t>(incarnation);
    if ((*described_)[endpoint].load(std::memory_order_relaxed) != incarnation) {
      describe(endpoint, incarnation);
    }
  }
  thread_rings.find(id_)->file->push(*ring, event);
}

/// Where only some nodes are traced: theirs, and what they do to other processes' endpoints.
bool Tracer::is_wanted(const EndpointEntry & endpoint) const noexcept {
  if (
    switch_.load(std::memory_order_relaxed)->load(std::memory_order_relaxed) !=
      TraceScope::some_nodes ||
    endpoint.process != identity_.process || endpoint.node >= node_capacity) {
    return true;
  }
  const auto & node =
    registry_.at<NodeEntry>(node_table_offset + uint64_t{endpoint.node} * sizeof(NodeEntry));
  return node.traced.load(std::memory_order_relaxed) != 0;
}

TraceRingWriter * Tracer::ring_of_this_thread() noexcept {
  ThreadRings::Ring * const known = thread_rings.find(id_);
  return known != nullptr ? &known->writer : add_ring();
}

TraceRingWriter * Tracer::add_ring() noexcept {
  const std::shared_ptr<TraceFile> file = this->file();
  if (file == nullptr) {
    header().trace.unplaced.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  try {
    if (const std::optional<TraceRingWriter> ring = file->add_ring()) {
      return &thread_rings.add({id_, file, *ring})->writer;
    }
  } catch (const std::bad_alloc &) {
    // Counted below; the ring stays unused.
  }
  file->count_unplaced();
  return nullptr;
}

std::shared_ptr<TraceFile> Tracer::file() noexcept {
  // Making one fails for a while where it failed: no descriptors, no memory.
  constexpr uint64_t between_tries = 1024;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (file_ != nullptr || failures_ % between_tries != 0) {
    failures_ += file_ == nullptr ? 1 : 0;
    return file_;
  }
  try {
    if (described_ == nullptr) {
      described_ = std::make_unique<std::array<std::atomic<uint32_t>, endpoint_capacity>>();
    }
    const uint32_t number = header().trace.files.fetch_add(1, std::memory_order_relaxed) + 1;
    const uint32_t events_log2 = std::clamp(
      header().trace.events_log2.load(std::memory_order_relaxed), min_trace_events_log2,
      max_trace_events_log2);
    file_ = std::make_shared<TraceFile>(
      directory_ + "/trace-" + std::to_string(number), identity_, events_log2);
  } catch (const std::exception &) {
    ++failures_;
  }
  return file_;
}

void Tracer::describe(uint32_t endpoint, uint32_t incarnation) noexcept {
  (*described_)[endpoint].store(incarnation, std::memory_order_relaxed);
  const EndpointEntry & entry = *endpoint_at(endpoint);
  TraceName name{};
  name.slot = endpoint;
  name.incarnation = incarnation;
  name.process = entry.process;
  name.cluster = entry.cluster;
  name.kind = static_cast<uint8_t>(entry.kind);
  name.role = static_cast<uint8_t>(entry.role);
  try {
    copy_text(name.topic, text_in(entry.topic));
    copy_text(name.type, text_in(entry.type));
    if (entry.node < header().nodes.high_water.load(std::memory_order_acquire)) {
      const auto & node =
        registry_.at<NodeEntry>(node_table_offset + uint64_t{entry.node} * sizeof(NodeEntry));
      const std::string ns = text_in(node.ns);
      copy_text(name.node, (ns == "/" ? "" : ns) + "/" + text_in(node.name));
    }
  } catch (const std::bad_alloc &) {
    return;
  }
  thread_rings.find(id_)->file->add_name(name);
}

}  // namespace manycore
