// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/registry/cluster.hpp"

#include <algorithm>
#include <utility>

#include "platform/error.hpp"
#include "platform/user_directory.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"

namespace manycore {
namespace {

/// 1 KiB for small SMEMs, one page for large ones.
uint32_t granule_size(uint64_t smem_bytes) { return smem_bytes <= (64u << 20) ? 1024 : page_bytes; }

uint64_t map_bytes(uint64_t granules) { return align_up(align_up(granules, 64) / 8, 8); }

/// ASCII only, independent of the locale.
bool is_name_start(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Replaces other characters: a NUL would end the error text, and Python requires UTF-8.
std::string printable(std::string text) {
  std::replace_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

constexpr const char * topic_dsm_advice =
  "lower topic_dsm_size or depth, or move nodes to another cluster";

Error no_room(const Cluster & cluster, uint64_t length, const std::string & why_and_advice) {
  return Error(
    ErrorCode::no_space, "cluster " + std::to_string(cluster.id()) + " has no room for " +
                           std::to_string(length) + " bytes: " + why_and_advice);
}

Error no_message_room(const Cluster & cluster, uint64_t length, const std::string & advice) {
  return no_room(
    cluster, length,
    cluster.fill_level() + ", and " + std::to_string(control_reserve_bytes(cluster.size())) +
      " are reserved for further nodes, publishers and subscriptions; " + advice);
}

}  // namespace

bool PlatformPaths::is_name(const std::string & platform) noexcept {
  return !platform.empty() && platform.size() <= 64 && is_name_start(platform[0]) &&
         std::all_of(platform.begin(), platform.end(), [](char c) {
           return is_name_start(c) || c == '-' || c == '.';
         });
}

PlatformPaths PlatformPaths::of(const std::string & platform) {
  if (!is_name(platform)) {
    throw Error(
      ErrorCode::invalid_argument, "'" + printable(platform) +
                                     "' is not a valid platform name: expected up to 64 letters, "
                                     "digits, '_', '.' and '-', not starting with '.' or '-'");
  }
  const UserDirectory user = UserDirectory::from_environment();
  return {user.path, user.path + "/" + platform, user.is_chosen};
}

void Cluster::create(
  const PlatformPaths & paths, uint32_t id, const Profile & profile, uint64_t platform_nonce) {
  const uint64_t smem_bytes = profile.smem_bytes;
  const SharedMemory memory = SharedMemory::create(paths.cluster(id), smem_bytes);
  memory.prefer_numa_node(profile.numa_node[id - 1]);  // refused: slower, `doctor` reports it
  const uint32_t granule = granule_size(smem_bytes);
  const uint64_t granules = smem_bytes / granule;
  memory.reserve(0, granule_map_offset + map_bytes(granules));
  auto & header = memory.at<ClusterHeader>(0);
  header.segment.version = layout_version;
  header.segment.cluster = id;
  header.segment.size_bytes = smem_bytes;
  header.segment.platform_nonce = platform_nonce;
  header.granule_bytes = granule;
  header.granule_count = static_cast<uint32_t>(granules);
  header.segment.magic.store(cluster_magic, std::memory_order_release);
  Pipe::create(paths.pipe(id));
  Cluster cluster(paths, id, platform_nonce);
  cluster.forget_allocations();
}

Cluster::Cluster(const PlatformPaths & paths, uint32_t id, uint64_t platform_nonce)
: id_(id),
  memory_(SharedMemory::open(paths.cluster(id), 4096)),
  pipe_(Pipe::open(paths.pipe(id))),
  granule_bytes_(granule_size(memory_.size())),
  granule_count_(memory_.size() / granule_bytes_) {
  const ClusterHeader & head = header();
  check_segment(head.segment, cluster_magic, memory_.size(), paths.cluster(id).c_str());
  const std::string advice = "; stop the platform's nodes and run 'manycore clean'";
  if (head.segment.cluster != id || head.segment.platform_nonce != platform_nonce) {
    throw Error(ErrorCode::corrupt, paths.cluster(id) + " belongs to another platform" + advice);
  }
  const bool sound = head.granule_bytes == granule_bytes_ && head.granule_count == granule_count_ &&
                     head.used_bytes.load(std::memory_order_relaxed) <= memory_.size();
  if (!sound) {
    throw Error(ErrorCode::corrupt, paths.cluster(id) + " has a damaged header" + advice);
  }
}

uint64_t Cluster::granules_of(uint64_t length) const noexcept {
  return (length + granule_bytes_ - 1) / granule_bytes_;
}

bool Cluster::granule_used(uint64_t index) const noexcept {
  return (granule_map()[index / 64] >> (index % 64) & 1) != 0;
}

void Cluster::set_granules(uint64_t first, uint64_t count, bool used) const noexcept {
  const uint64_t end = first + count;
  for (uint64_t i = first, next = 0; i < end; i = next) {
    next = std::min(end, (i / 64 + 1) * 64);
    const uint64_t bits = ~uint64_t{0} >> (64 - (next - i)) << (i % 64);
    uint64_t & word = granule_map()[i / 64];
    word = used ? word | bits : word & ~bits;
  }
}

/// First used (or free) granule from `from` on; granule_count_ if there is none.
uint64_t Cluster::find_granule(uint64_t from, bool used) const noexcept {
  const uint64_t end = used_before();
  for (uint64_t i = from; i < end; i = (i / 64 + 1) * 64) {
    const uint64_t word = used ? granule_map()[i / 64] : ~granule_map()[i / 64];
    const uint64_t rest = word >> (i % 64);
    if (rest != 0) {
      return std::min(i + static_cast<uint64_t>(__builtin_ctzll(rest)), granule_count_);
    }
  }
  return used ? granule_count_ : std::max(from, end);
}

/// First fit; granule_count_ if no run is long enough.
uint64_t Cluster::find_run(uint64_t count) const noexcept {
  std::atomic<uint64_t> & free_from = header().free_from;
  uint64_t first = find_granule(free_from.load(std::memory_order_relaxed), false);
  free_from.store(first, std::memory_order_relaxed);
  while (first < granule_count_ && count <= granule_count_ - first) {
    const uint64_t end = find_granule(first, true);
    if (end - first >= count) {
      return first;
    }
    first = find_granule(end, false);
  }
  return granule_count_;
}

uint64_t Cluster::used_before() const noexcept {
  return std::min(header().used_before.load(std::memory_order_relaxed), granule_count_);
}

void Cluster::note_allocated(uint64_t first, uint64_t count) const noexcept {
  ClusterHeader & head = header();
  set_granules(first, count, true);
  if (head.free_from.load(std::memory_order_relaxed) == first) {
    head.free_from.store(first + count, std::memory_order_relaxed);
  }
  if (used_before() < first + count) {
    head.used_before.store(first + count, std::memory_order_relaxed);
  }
}

void Cluster::note_freed(uint64_t first, uint64_t count) const noexcept {
  ClusterHeader & head = header();
  set_granules(first, count, false);
  if (first < head.free_from.load(std::memory_order_relaxed)) {
    head.free_from.store(first, std::memory_order_relaxed);
  }
  if (used_before() == first + count) {
    uint64_t end = first;
    while (end != 0 && !granule_used(end - 1)) {
      const bool is_word_free = end % 64 == 0 && granule_map()[end / 64 - 1] == 0;
      end -= is_word_free ? 64 : 1;
    }
    head.used_before.store(end, std::memory_order_relaxed);
  }
}

/// Map and `used_bytes` are changed together under the registry lock. If its owner dies in
/// between, the next owner rebuilds both. Most words of a large map are empty or full, which needs
/// no bit count.
void Cluster::require_sound_map() const {
  const ClusterHeader & head = header();
  uint64_t used = 0;
  for (uint64_t i = 0; i < (used_before() + 63) / 64; ++i) {
    const uint64_t word = granule_map()[i];
    const bool is_mixed = word + 1 > 1;  // neither empty nor full
    used += is_mixed ? static_cast<uint64_t>(__builtin_popcountll(word)) : word & 64;
  }
  if (used * granule_bytes_ != head.used_bytes.load(std::memory_order_relaxed)) {
    throw Error(
      ErrorCode::corrupt, "the memory map of cluster " + std::to_string(id_) +
                            " is damaged; stop the platform's nodes and run 'manycore clean'");
  }
}

void Cluster::require_message_room(uint64_t length) const {
  const uint64_t bytes = granules_of(length) * granule_bytes_;
  if (!has_room(bytes + control_reserve_bytes(size()))) {
    throw no_message_room(*this, length, topic_dsm_advice);
  }
}

void Cluster::require_file_system_room(uint64_t length) const {
  const uint64_t bytes = granules_of(length) * granule_bytes_;
  const FileSystemRoom host = memory_.file_system_room();
  const bool is_limited = host.total_bytes != 0;  // a tmpfs mounted with size=0 is unlimited
  if (is_limited && host.free_bytes < bytes + control_reserve_bytes(host.total_bytes)) {
    throw no_room(
      *this, length,
      std::to_string(host.free_bytes) + " of the " + std::to_string(host.total_bytes) +
        " bytes of " + memory_.path() + "'s file system are free, and " +
        std::to_string(control_reserve_bytes(host.total_bytes)) +
        " are reserved for further nodes, publishers and subscriptions; enlarge it (mount -o "
        "remount,size=...) or lower topic_dsm_size");
  }
}

void Cluster::populate(uint64_t offset, uint64_t length) const noexcept {
  if (contains(offset, length)) {
    memory_.populate(offset, length);
  }
}

void Cluster::populate_map() const noexcept {
  populate(0, granule_map_offset + map_bytes(granule_count_));
}

/// Populates only: a fallocate() that fails would take back pages that others allocate meanwhile.
/// Another process may do that with all of the range; then allocate() backs what it needs itself.
void Cluster::back_ahead() noexcept {
  const uint64_t from = header().free_from.load(std::memory_order_relaxed) * granule_bytes_;
  const uint64_t before = backed_ahead_from_.load(std::memory_order_relaxed);
  const bool is_enough_left = from >= before && from - before <= backed_ahead_bytes / 2;
  if (!is_enough_left && contains(from, backed_ahead_bytes)) {
    memory_.populate(from, backed_ahead_bytes);
    backed_ahead_from_.store(from, std::memory_order_relaxed);
  }
}

uint64_t Cluster::allocate(uint64_t length) {
  const uint64_t offset = reserve(length);
  try {
    back(offset, length);
  } catch (...) {
    free(offset, length);
    throw;
  }
  return offset;
}

uint64_t Cluster::reserve(uint64_t length) {
  require_sound_map();
  ClusterHeader & head = header();
  const uint64_t count = granules_of(length);
  const uint64_t first = find_run(count);
  if (first == granule_count_ || !has_room(count * granule_bytes_)) {
    throw no_room(*this, length, fill_level() + "; " + topic_dsm_advice);
  }
  const uint64_t offset = first * granule_bytes_;
  const uint64_t bytes = count * granule_bytes_;
  if (granule_bytes_ < page_bytes) {
    // Back and touch shared pages under the lock: a fallocate() that fails takes back all untouched
    // pages of its range, including those of a neighbour.
    memory_.reserve_and_populate(offset, 1);
    memory_.reserve_and_populate(offset + bytes - 1, 1);
  }
  note_allocated(first, count);
  head.used_bytes.fetch_add(bytes, std::memory_order_relaxed);
  return offset;
}

void Cluster::back(uint64_t offset, uint64_t length) const {
  memory_.reserve_and_populate(offset, granules_of(length) * granule_bytes_);
}

void Cluster::free(uint64_t offset, uint64_t length) noexcept {
  if (makes_hole(length)) {
    punch(offset, length);
  }
  unmark(offset, length);
}

bool Cluster::makes_hole(uint64_t length) const noexcept {
  return granules_of(length) * granule_bytes_ >= min_hole_bytes;
}

void Cluster::punch(uint64_t offset, uint64_t length) noexcept {
  const uint64_t bytes = granules_of(length) * granule_bytes_;
  if (contains(offset, bytes)) {
    memory_.release(offset, bytes);
    backed_ahead_from_.store(UINT64_MAX, std::memory_order_relaxed);  // may be a hole now
  }
}

void Cluster::unmark(uint64_t offset, uint64_t length) noexcept {
  const uint64_t count = granules_of(length);
  if (contains(offset, count * granule_bytes_)) {
    note_freed(offset / granule_bytes_, count);
    header().used_bytes.fetch_sub(count * granule_bytes_, std::memory_order_relaxed);
  }
}

void Cluster::wake_reaper(uint32_t process) const noexcept {
  EmcosMessage message{};
  message.kind = EmcosMessageKind::attach;
  message.process = process;
  if (!send(message)) {
    header().pipe_overflow.store(1, std::memory_order_seq_cst);
  }
}

/// Either the pipe is still full after `pipe_overflow` is set: then the receive thread has yet to
/// read from it, and checks the flag afterwards. Or the message fits.
void Cluster::wake_resyncing() const noexcept {
  header().pipe_overflow.store(1, std::memory_order_seq_cst);
  EmcosMessage message{};
  message.kind = EmcosMessageKind::resync;
  send(message);
}

std::string Cluster::fill_level() const {
  return std::to_string(used_bytes()) + " of its " + std::to_string(size()) +
         " bytes of SMEM are used";
}

bool Cluster::has_room(uint64_t length) const noexcept {
  const uint64_t used = used_bytes();
  return used <= size() && length <= size() - used;
}

void Cluster::charge(uint64_t before, uint64_t after) {
  if (after > before && !has_room(after - before + control_reserve_bytes(size()))) {
    const char * const advice = "raise smem_size in the mapfile, or move nodes to another cluster";
    throw no_message_room(*this, after - before, advice);
  }
  header().charged_bytes.fetch_add(after - before, std::memory_order_relaxed);
}

void Cluster::mark_charged(uint64_t length) noexcept {
  header().charged_bytes.fetch_add(length, std::memory_order_relaxed);
}

void Cluster::forget_allocations() noexcept {
  ClusterHeader & head = header();
  const uint64_t own = granules_of(granule_map_offset + map_bytes(granule_count_));
  std::fill_n(granule_map(), map_bytes(granule_count_) / 8, 0);
  head.free_from.store(0, std::memory_order_relaxed);
  head.used_before.store(0, std::memory_order_relaxed);
  note_allocated(0, own);
  head.used_bytes.store(own * granule_bytes_, std::memory_order_relaxed);
  head.charged_bytes.store(0, std::memory_order_relaxed);
}

bool Cluster::is_allocated(uint64_t offset) const noexcept {
  return contains(offset, granule_bytes_) && granule_used(offset / granule_bytes_);
}

void Cluster::mark_allocated(uint64_t offset, uint64_t length) noexcept {
  ClusterHeader & head = header();
  const uint64_t count = granules_of(length);
  if (!contains(offset, count * granule_bytes_)) {
    return;
  }
  note_allocated(offset / granule_bytes_, count);
  head.used_bytes.fetch_add(count * granule_bytes_, std::memory_order_relaxed);
}

Clusters::Clusters(PlatformPaths paths, uint64_t platform_nonce)
: paths_(std::move(paths)), platform_nonce_(platform_nonce) {}

Cluster & Clusters::at(uint32_t id) {
  if (id == 0 || id > max_clusters) {
    throw Error(ErrorCode::corrupt, "there is no cluster " + std::to_string(id));
  }
  if (Cluster * const known = mapped_[id].load(std::memory_order_acquire)) {
    return *known;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!owned_[id]) {
    owned_[id] = std::make_unique<Cluster>(paths_, id, platform_nonce_);
    mapped_[id].store(owned_[id].get(), std::memory_order_release);
  }
  return *owned_[id];
}

Cluster * Clusters::find(uint32_t id) noexcept {
  try {
    return &at(id);
  } catch (const std::exception &) {
    return nullptr;
  }
}

}  // namespace manycore
