// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "platform/lasting_descriptor.hpp"

namespace manycore {

/// Of a file system, as far as its ordinary users may fill it.
struct FileSystemRoom {
  uint64_t free_bytes = 0;
  uint64_t total_bytes = 0;
};

/// A shared mapping of one file in /dev/shm. The file is sparse: only reserved ranges hold memory,
/// so a small /dev/shm shows at reserve() and never as SIGBUS.
class SharedMemory {
public:
  SharedMemory() = default;
  SharedMemory(SharedMemory && other) noexcept;
  SharedMemory & operator=(SharedMemory && other) noexcept;
  ~SharedMemory();

  /// Creates `path` (mode 0600, must not exist) with `size_bytes`, nothing reserved.
  static SharedMemory create(const std::string & path, size_t size_bytes);
  /// Maps an existing file of this user. Throws Error{corrupt} below `least_size_bytes`.
  static SharedMemory open(const std::string & path, size_t least_size_bytes);
  /// Memory without a file, all of it reserved: it is gone with the last process that maps it.
  /// `label` shows in /proc/<pid>/maps. Others attach() to its shared_path().
  static SharedMemory anonymous(const std::string & label, size_t size_bytes);

  /// Maps the memory that another process made with anonymous() and named by shared_path().
  static SharedMemory attach(const std::string & shared_path);

  std::byte * data() const noexcept { return data_; }
  const std::string & path() const noexcept { return path_; }
  size_t size() const noexcept { return size_; }
  /// False once its file was removed or replaced. Needs no descriptor.
  bool is_file(const std::string & path) const noexcept { return file_.is_at(path); }
  /// Where another process of this user finds the same memory while this one lives.
  std::string shared_path() const;
  explicit operator bool() const noexcept { return data_ != nullptr; }

  template<typename T>
  T & at(uint64_t offset) const noexcept {
    return *reinterpret_cast<T *>(data_ + offset);
  }

  /// Of the file system that its file is in.
  FileSystemRoom file_system_room() const noexcept;
  /// Backs [offset, offset + length) with memory; throws Error{no_space} naming the size needed.
  void reserve(uint64_t offset, uint64_t length) const;
  /// reserve() and populate() in steps. The kernel locks the file for one step at a time, so that
  /// others can back their memory meanwhile. What was backed before an Error stays backed.
  void reserve_and_populate(uint64_t offset, uint64_t length) const;
  /// Maps the pages of a reserved range into this process, so that first use does not fault.
  void populate(uint64_t offset, uint64_t length) const noexcept;
  /// Gives the whole pages inside the range back to the system; they read as zero afterwards.
  void release(uint64_t offset, uint64_t length) const noexcept;

private:
  static SharedMemory open(const std::string & path, size_t least_size_bytes, int flags);
  SharedMemory(FileDescriptor fd, const std::string & path, size_t size_bytes, int flags);
  void unmap() noexcept;
  /// An errno.
  int try_reserve(uint64_t first, uint64_t bytes) const noexcept;
  [[noreturn]] void throw_no_space(uint64_t bytes) const;

  LastingDescriptor file_;
  std::string path_;
  std::byte * data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace manycore
