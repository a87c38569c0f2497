// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/trace/tracer.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "virtual_time/door.hpp"

namespace manycore {

/// The ring of one thread for one platform.
struct ThreadRing {
  uint64_t tracer;
  std::shared_ptr<TraceFile> file;  ///< keeps the mapping during the thread's lifetime
  TraceRingWriter writer;
  int64_t cpu_due_ns = 0;  ///< the thread's CPU time is read no earlier
};

namespace {

constexpr TraceSwitch never{TraceScope::off};

/// Reading a thread's CPU time is a system call: at most one in this time, so that a traced round
/// trip of 10 us hardly pays for it, and callbacks that matter still have their own.
constexpr int64_t cpu_period_ns = 200'000;

/// Ring that the thread used last. Plain data accessed without a function call, so an active trace
/// site costs less than reading the clock.
struct LastRing {
  uint64_t tracer;
  ThreadRing * ring;
  bool is_ending;  ///< the thread's rings are destroyed; later destructors may still trace
};
[[gnu::tls_model("initial-exec")]] thread_local LastRing last_ring{};

/// The rings of a thread, one for each platform.
class ThreadRings {
public:
  ~ThreadRings() {
    last_ring = {0, nullptr, true};
    for (ThreadRing & ring : rings_) {
      end(ring);
    }
  }

  ThreadRing * find(uint64_t tracer) noexcept {
    const auto found = std::find_if(
      rings_.begin(), rings_.end(), [&](const ThreadRing & ring) { return ring.tracer == tracer; });
    return found == rings_.end() ? nullptr : remember(*found);
  }

  ThreadRing * add(ThreadRing && fresh) {
    last_ring = {};
    // Drop rings of platforms that the process has left.
    const auto gone = std::remove_if(rings_.begin(), rings_.end(), [](const ThreadRing & ring) {
      return ring.file.use_count() == 1;
    });
    std::for_each(gone, rings_.end(), end);
    rings_.erase(gone, rings_.end());
    rings_.push_back(std::move(fresh));
    return remember(rings_.back());
  }

private:
  static ThreadRing * remember(ThreadRing & ring) noexcept {
    last_ring = {ring.tracer, &ring, false};
    return &ring;
  }

  static void end(ThreadRing & ring) noexcept {
    if (ring.file != nullptr && !ring.file->is_inherited()) {
      ring.writer.ring().state.store(TraceRingState::ended, std::memory_order_release);
    }
  }

  std::vector<ThreadRing> rings_;
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

void Tracer::follow(
  const TraceSwitch & by, const TraceIdentity & identity, const ClusterHeader & cluster) {
  const std::lock_guard<std::mutex> lock(mutex_);
  identity_ = identity;
  identity_.platform_nonce = header().segment.platform_nonce;
  cluster_.store(&cluster, std::memory_order_relaxed);
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
  TraceEvent event{qos_now_ns(), number, value, endpoint, 0, kind};
  ThreadRing * const ring = ring_of_this_thread();
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
      describe(*ring->file, endpoint, incarnation);
    }
  }
  const bool is_wait = kind == TraceKind::wait_begin || kind == TraceKind::wait_end;
  if (is_wait && event.time_ns >= ring->cpu_due_ns) {
    event.number = static_cast<uint64_t>(clock_ns(CLOCK_THREAD_CPUTIME_ID));
    ring->cpu_due_ns = event.time_ns + cpu_period_ns;
  }
  ring->file->push(ring->writer, event);
  if (ring->file->is_sample_due(event.time_ns)) {
    sample(*ring, event.time_ns);
  }
}

void Tracer::note_other(
  TraceKind kind, uint32_t index, uint16_t step, uint64_t number, uint64_t value) noexcept {
  if (!is_on() || side_.is_inherited()) {
    return;
  }
  if (ThreadRing * const ring = ring_of_this_thread()) {
    ring->file->push(ring->writer, {qos_now_ns(), number, value, index, step, kind});
  }
}

void Tracer::sample(ThreadRing & ring, int64_t time_ns) noexcept {
  const auto cpu_ns = static_cast<uint64_t>(clock_ns(CLOCK_PROCESS_CPUTIME_ID));
  ring.file->push_sample(ring.writer, {time_ns, 0, cpu_ns, nothing, 0, TraceKind::cpu});
  if (const ClusterHeader * const cluster = cluster_.load(std::memory_order_relaxed)) {
    const uint64_t used_bytes = cluster->used_bytes.load(std::memory_order_relaxed) +
                                cluster->charged_bytes.load(std::memory_order_relaxed);
    ring.file->push_sample(
      ring.writer, {time_ns, cluster->segment.cluster, used_bytes, nothing, 0, TraceKind::smem});
  }
}

/// In scope some_nodes: events of traced nodes, and hints for endpoints of other processes.
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

ThreadRing * Tracer::ring_of_this_thread() noexcept {
  if (__builtin_expect(last_ring.tracer == id_, 1)) {
    return last_ring.ring;
  }
  if (last_ring.is_ending) {
    header().trace.unplaced.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  ThreadRing * const known = thread_rings.find(id_);
  return known != nullptr ? known : add_ring();
}

ThreadRing * Tracer::add_ring() noexcept {
  const std::shared_ptr<TraceFile> file = this->file();
  if (file == nullptr) {
    header().trace.unplaced.fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  try {
    if (const std::optional<TraceRingWriter> ring = file->add_ring()) {
      return thread_rings.add({id_, file, *ring});
    }
  } catch (const std::bad_alloc &) {
    // Counted below; the ring stays unused.
  }
  file->count_unplaced();
  return nullptr;
}

std::shared_ptr<TraceFile> Tracer::file() noexcept {
  // After a failure (no file descriptors, no memory), try again only after this many events.
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

void Tracer::describe(TraceFile & file, uint32_t endpoint, uint32_t incarnation) noexcept {
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
  file.add_name(name);
}

}  // namespace manycore
