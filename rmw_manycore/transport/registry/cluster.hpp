// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>

#include "platform/pipe.hpp"
#include "platform/shared_memory.hpp"
#include "transport/layout/cluster_layout.hpp"
#include "transport/layout/emcos_message.hpp"
#include "transport/layout/registry_layout.hpp"

namespace manycore {

/// Paths of a platform's files.
struct PlatformPaths {
  /// Cannot collide with a platform's directory: platform names do not start with a dot.
  static constexpr const char * join_lock_name = ".lock";
  std::string user_directory;  ///< /dev/shm/manycore-<uid>, or MANYCORE_DIRECTORY
  std::string directory;       ///< .../<platform>
  bool is_chosen = false;      ///< `user_directory` is MANYCORE_DIRECTORY

  /// Throws Error{invalid_argument} for an invalid platform name, and the errors of
  /// UserDirectory::from_environment().
  static PlatformPaths of(const std::string & platform);
  static bool is_name(const std::string & platform) noexcept;
  std::string join_lock() const { return user_directory + "/" + join_lock_name; }
  std::string registry() const { return directory + "/registry"; }
  std::string alive() const { return directory + "/alive"; }
  std::string cluster(uint32_t id) const { return directory + "/cluster-" + std::to_string(id); }
  std::string pipe(uint32_t id) const { return cluster(id) + ".pipe"; }
  /// Of packets, by priority; of requests to copy. Only where topics are transferred.
  std::string data_pipe(uint32_t id, uint32_t priority) const {
    return cluster(id) + ".data-" + std::to_string(priority);
  }
  std::string session_pipe(uint32_t id) const { return cluster(id) + ".sessions"; }
};

/// More than the small blocks that one hold of the registry lock allocates.
constexpr uint64_t backed_ahead_bytes = 64 << 10;

/// A cluster's SMEM and pipe, mapped into this process.
class Cluster {
public:
  /// Creates segment and pipe. The caller holds the join lock.
  static void create(
    const PlatformPaths & paths, uint32_t id, const Profile & profile, uint64_t platform_nonce);
  /// Throws Error{corrupt}.
  Cluster(const PlatformPaths & paths, uint32_t id, uint64_t platform_nonce);

  uint32_t id() const noexcept { return id_; }
  ClusterHeader & header() const noexcept { return memory_.at<ClusterHeader>(0); }
  uint64_t size() const noexcept { return memory_.size(); }
  /// Unit of SMEM allocation in bytes.
  uint64_t granule_bytes() const noexcept { return granule_bytes_; }

  /// True if [offset, offset + length) is inside the SMEM.
  bool contains(uint64_t offset, uint64_t length) const noexcept {
    return offset <= memory_.size() && length <= memory_.size() - offset;
  }
  /// Object at an offset, or nullptr if it would be out of bounds or misaligned. References in
  /// shared memory are always checked.
  template<typename T>
  T * find(uint64_t offset, uint64_t length = sizeof(T)) const noexcept {
    return offset % alignof(T) == 0 && contains(offset, length) ? &memory_.at<T>(offset) : nullptr;
  }

  /// Copies a range that may be freed meanwhile, even if this process follows its reference neither
  /// in a phase nor under the registry lock. See SharedMemory::copy_out().
  bool copy_out(uint64_t offset, void * to, size_t length) const noexcept {
    return contains(offset, length) && memory_.copy_out(offset, to, length);
  }

  /// Throws Error{no_space} unless `length` bytes of messages leave the control reserve of the
  /// SMEM. The caller holds the registry lock.
  void require_message_room(uint64_t length) const;
  /// The same for the file system; call before memory is backed.
  void require_file_system_room(uint64_t length) const;
  /// Maps a range, or the map of granules, into this process, so that the first access does not
  /// fault.
  void populate(uint64_t offset, uint64_t length) const noexcept;
  void populate_map() const noexcept;
  /// Backs, as far as there is room, the `backed_ahead_bytes` from which small blocks are allocated
  /// next, so that allocate() under the registry lock finds them backed. Needs no lock.
  void back_ahead() noexcept;
  /// Allocates SMEM, backed but not cleared; returns its offset. The caller holds the registry
  /// lock. Throws Error{no_space|corrupt}.
  uint64_t allocate(uint64_t length);
  /// First half of allocate(): reserves SMEM that must not be accessed before back(). The caller
  /// holds the registry lock. Throws Error{no_space|corrupt}.
  uint64_t reserve(uint64_t length);
  /// Second half of allocate(): backs reserved SMEM with memory. Needs no lock; takes time in
  /// proportion to `length`. Throws Error{no_space}.
  void back(uint64_t offset, uint64_t length) const;
  template<typename T>
  T & allocate_cleared(uint64_t length = sizeof(T)) {
    const uint64_t offset = allocate(length);
    std::memset(&memory_.at<std::byte>(offset), 0, length);
    return memory_.at<T>(offset);
  }
  SegmentRef ref_of(const void * object) const noexcept {
    return SegmentRef::make(
      id_, static_cast<uint64_t>(static_cast<const std::byte *>(object) - memory_.data()));
  }
  /// Frees SMEM, and returns the memory of larger blocks to the system. The caller holds the
  /// registry lock. The range must not be accessed until it is allocated again.
  void free(uint64_t offset, uint64_t length) noexcept;
  /// True for a block whose memory goes back to the system.
  bool makes_hole(uint64_t length) const noexcept;
  /// First half of free() for a block that makes a hole. Needs no lock; takes time in proportion to
  /// `length`.
  void punch(uint64_t offset, uint64_t length) noexcept;
  /// Second half of free(). The caller holds the registry lock.
  void unmark(uint64_t offset, uint64_t length) noexcept;
  /// Changes the bytes that a process has charged from `before` to `after`. The caller holds the
  /// registry lock. Throws Error{no_space}.
  void charge(uint64_t before, uint64_t after);
  /// Allocated and charged bytes.
  uint64_t used_bytes() const noexcept {
    return header().used_bytes.load(std::memory_order_relaxed) +
           header().charged_bytes.load(std::memory_order_relaxed);
  }
  /// For texts: how much of the SMEM is used.
  std::string fill_level() const;
  /// Rebuilds the map after an owner of the registry lock died: clear it, then mark all live
  /// blocks.
  void forget_allocations() noexcept;
  void mark_allocated(uint64_t offset, uint64_t length) noexcept;
  bool is_allocated(uint64_t offset) const noexcept;
  void mark_charged(uint64_t length) noexcept;

  /// False if the pipe is full.
  bool send(const EmcosMessage & message) const noexcept {
    return pipe_.try_send(&message, sizeof message);
  }
  /// Makes the reaper of the receive thread watch a process that joins, or check all processes if
  /// `process` is `nothing`. If the pipe is full, the reaper does so after the receive thread has
  /// emptied it.
  void wake_reaper(uint32_t process = nothing) const noexcept;
  /// Makes the receive thread wake the subscriptions that the caller has set to resync, because
  /// their hints found the pipe full.
  void wake_resyncing() const noexcept;
  const Pipe & pipe() const noexcept { return pipe_; }

private:
  uint64_t * granule_map() const noexcept { return &memory_.at<uint64_t>(granule_map_offset); }
  bool granule_used(uint64_t index) const noexcept;
  void set_granules(uint64_t first, uint64_t count, bool used) const noexcept;
  uint64_t find_granule(uint64_t from, bool used) const noexcept;
  uint64_t used_before() const noexcept;
  void note_allocated(uint64_t first, uint64_t count) const noexcept;
  void note_freed(uint64_t first, uint64_t count) const noexcept;
  /// Throws Error{corrupt}.
  void require_sound_map() const;
  uint64_t find_run(uint64_t count) const noexcept;
  bool has_room(uint64_t length) const noexcept;
  uint64_t granules_of(uint64_t length) const noexcept;

  uint32_t id_;
  SharedMemory memory_;
  Pipe pipe_;
  // Copies of the header's fields, which may be damaged later.
  uint64_t granule_bytes_;
  uint64_t granule_count_;
  std::atomic<uint64_t> backed_ahead_from_{UINT64_MAX};  ///< by this process, last
};

/// The clusters mapped by this process, each on first use. Thread-safe; lock-free for mapped
/// clusters.
class Clusters {
public:
  Clusters(PlatformPaths paths, uint64_t platform_nonce);
  /// Throws Error{corrupt|system} if the cluster cannot be mapped.
  Cluster & at(uint32_t id);
  /// Nullptr if the cluster cannot be mapped.
  Cluster * find(uint32_t id) noexcept;
  /// Object behind a reference, or nullptr if the reference is invalid.
  template<typename T>
  T * find(SegmentRef ref, uint64_t length = sizeof(T)) noexcept {
    Cluster * const cluster = find(ref.cluster());
    return cluster == nullptr ? nullptr : cluster->find<T>(ref.offset(), length);
  }

private:
  PlatformPaths paths_;
  uint64_t platform_nonce_;
  std::mutex mutex_;
  std::array<std::atomic<Cluster *>, max_clusters + 1> mapped_{};
  std::array<std::unique_ptr<Cluster>, max_clusters + 1> owned_;
};

}  // namespace manycore
