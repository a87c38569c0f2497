// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>

#include "platform/pipe.hpp"
#include "platform/shared_memory.hpp"
#include "transport/layout/cluster_layout.hpp"
#include "transport/layout/emcos_message.hpp"

namespace manycore {

/// Paths of a platform's files.
struct PlatformPaths {
  /// No platform name begins with a dot, so no platform's directory has this name.
  static constexpr const char * join_lock_name = ".lock";
  std::string user_directory;  ///< /dev/shm/manycore-<uid>, or MANYCORE_DIRECTORY
  std::string directory;       ///< .../<platform>
  bool is_chosen = false;      ///< the user directory is MANYCORE_DIRECTORY

  /// Throws Error{invalid_argument} for what is no platform name, and what
  /// UserDirectory::from_environment() throws.
  static PlatformPaths of(const std::string & platform);
  static bool is_name(const std::string & platform) noexcept;
  std::string join_lock() const { return user_directory + "/" + join_lock_name; }
  std::string registry() const { return directory + "/registry"; }
  std::string alive() const { return directory + "/alive"; }
  std::string cluster(uint32_t id) const { return directory + "/cluster-" + std::to_string(id); }
  std::string pipe(uint32_t id) const { return cluster(id) + ".pipe"; }
};

/// A cluster's SMEM and pipe, mapped into this process.
class Cluster {
public:
  /// Creates segment and pipe; the caller holds the join lock.
  static void create(
    const PlatformPaths & paths, uint32_t id, uint64_t smem_bytes, uint64_t platform_nonce);
  /// Throws Error{corrupt}.
  Cluster(const PlatformPaths & paths, uint32_t id, uint64_t platform_nonce);

  uint32_t id() const noexcept { return id_; }
  ClusterHeader & header() const noexcept { return memory_.at<ClusterHeader>(0); }
  uint64_t size() const noexcept { return memory_.size(); }
  /// SMEM is given out in whole granules.
  uint64_t granule_bytes() const noexcept { return granule_bytes_; }

  /// True when [offset, offset + length) is inside the SMEM.
  bool contains(uint64_t offset, uint64_t length) const noexcept {
    return offset <= memory_.size() && length <= memory_.size() - offset;
  }
  /// Nullptr for a reference that is out of bounds or where no T can be: shared memory is never
  /// followed blindly.
  template<typename T>
  T * find(uint64_t offset, uint64_t length = sizeof(T)) const noexcept {
    return offset % alignof(T) == 0 && contains(offset, length) ? &memory_.at<T>(offset) : nullptr;
  }

  /// Throws Error{no_space} unless `length` bytes of messages leave the SMEM's control reserve; the
  /// caller holds the registry lock.
  void require_message_room(uint64_t length) const;
  /// The same of the file system, before memory is backed.
  void require_file_system_room(uint64_t length) const;
  /// Allocation of SMEM, resident but not cleared; the caller holds the registry lock. Throws
  /// Error{no_space|corrupt}.
  uint64_t allocate(uint64_t length);
  /// The two halves of allocate(). Takes SMEM that nothing may touch yet; the caller holds the
  /// registry lock. Throws Error{no_space|corrupt}.
  uint64_t reserve(uint64_t length);
  /// Makes reserved SMEM resident; needs no lock, and takes as long as the memory is large. Throws
  /// Error{no_space}.
  void back(uint64_t offset, uint64_t length) const;
  template<typename T>
  T & allocate_cleared(uint64_t length = sizeof(T)) {
    const uint64_t offset = allocate(length);
    std::memset(&memory_.at<std::byte>(offset), 0, length);
    return memory_.at<T>(offset);
  }
  /// Gives memory behind allocated SMEM back to the system, as far as it is whole pages; needs no
  /// lock. Nothing may touch it until it is allocated anew.
  void release(uint64_t offset, uint64_t length) const noexcept { memory_.release(offset, length); }
  SegmentRef ref_of(const void * object) const noexcept {
    return SegmentRef::make(
      id_, static_cast<uint64_t>(static_cast<const std::byte *>(object) - memory_.data()));
  }
  void free(uint64_t offset, uint64_t length) noexcept;
  /// Counts `after` instead of `before` bytes that a process holds outside the segment; the caller
  /// holds the registry lock. Throws Error{no_space}.
  void charge(uint64_t before, uint64_t after);
  /// Allocated and charged.
  uint64_t used_bytes() const noexcept {
    return header().used_bytes.load(std::memory_order_relaxed) +
           header().charged_bytes.load(std::memory_order_relaxed);
  }
  /// Rebuilding the map after an owner of the registry lock died: forget all, then mark what lives.
  void forget_allocations() noexcept;
  void mark_allocated(uint64_t offset, uint64_t length) noexcept;
  void mark_charged(uint64_t length) noexcept;

  /// False when the pipe is full.
  bool send(const EmcosMessage & message) const noexcept {
    return pipe_.try_send(&message, sizeof message);
  }
  /// Has the receive thread's reaper look at all members, now or, where the pipe is full, once it
  /// has read what is in there.
  void wake_reaper() const noexcept;
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
  // As in the header, which may be damaged later.
  uint64_t granule_bytes_;
  uint64_t granule_count_;
};

/// The clusters that this process has mapped, each on first use. Thread-safe, lock-free once
/// mapped.
class Clusters {
public:
  Clusters(PlatformPaths paths, uint64_t platform_nonce);
  /// Throws Error{corrupt|system} when it cannot be mapped.
  Cluster & at(uint32_t id);
  /// Nullptr when it cannot be mapped.
  Cluster * find(uint32_t id) noexcept;
  /// The object behind a reference, or nullptr when it leads nowhere.
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
