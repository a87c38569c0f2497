// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "platform/lasting_descriptor.hpp"

namespace manycore {

constexpr uint64_t page_bytes = 4096;

/// Room of a file system for unprivileged users.
struct FileSystemRoom {
  uint64_t free_bytes = 0;
  uint64_t total_bytes = 0;
};

/// A shared mapping of one file, usually in /dev/shm. The file is sparse: only reserved ranges have
/// memory, so a full file system causes an error in reserve(), never SIGBUS.
class SharedMemory {
public:
  SharedMemory() = default;
  SharedMemory(SharedMemory && other) noexcept;
  SharedMemory & operator=(SharedMemory && other) noexcept;
  ~SharedMemory();

  /// Creates `path` with mode 0600 and `size_bytes`, nothing reserved. The file must not exist, and
  /// its directory be private to this user, as for open().
  static SharedMemory create(const std::string & path, size_t size_bytes);
  /// Maps an existing file. Throws Error{permission} if file or directory are not private to this
  /// user, Error{corrupt} if the file is smaller than `min_size_bytes`.
  static SharedMemory open(const std::string & path, size_t min_size_bytes);
  /// Memory without a file, completely reserved; it is freed with the last process that maps it.
  /// `label` is shown in /proc/<pid>/maps. Other processes attach() to its shared_path().
  static SharedMemory anonymous(const std::string & label, size_t size_bytes);

  /// Maps memory that another process of this user created with anonymous(), by its shared_path().
  static SharedMemory attach(const std::string & shared_path);

  std::byte * data() const noexcept { return data_; }
  const std::string & path() const noexcept { return path_; }
  size_t size() const noexcept { return size_; }
  /// True while `path` names the mapped file. Needs no descriptor.
  bool is_file(const std::string & path) const noexcept { return file_.is_at(path); }
  /// Path by which other processes of this user can map the same memory while this process lives.
  std::string shared_path() const;
  explicit operator bool() const noexcept { return data_ != nullptr; }

  template<typename T>
  T & at(uint64_t offset) const noexcept {
    return *reinterpret_cast<T *>(data_ + offset);
  }

  /// Makes the kernel take the file's further pages from this NUMA node while it has free memory,
  /// whichever process needs them. False where the system refuses, as containers may; the pages are
  /// then from the node of the CPU that needs them. None is preferred if it is negative.
  bool prefer_numa_node(int node) const noexcept;

  /// Room of the file system that holds the file.
  FileSystemRoom file_system_room() const noexcept;
  /// Backs [offset, offset + length) with memory. Throws Error{no_space} naming the size needed.
  void reserve(uint64_t offset, uint64_t length) const;
  /// reserve() and populate() in steps. The kernel locks the file for one step at a time, so other
  /// processes can back memory in between. After an Error, completed steps stay backed.
  void reserve_and_populate(uint64_t offset, uint64_t length) const;
  /// Maps the pages of a reserved range into this process, so that the first access does not fault.
  void populate(uint64_t offset, uint64_t length) const noexcept;
  /// Copies a range by the file, not by the mapping: a page that was released reads as zeros and
  /// gets no memory, whereas a load would allocate it, and raise SIGBUS if the file system is full.
  /// Words that others write meanwhile may be of different moments. False without a file
  /// descriptor.
  bool copy_out(uint64_t offset, void * to, size_t length) const noexcept;
  /// Returns the whole pages inside the range to the system; they read as zero afterwards.
  void release(uint64_t offset, uint64_t length) const noexcept;

private:
  /// `flags` reopen `path`. Throws the errno of open() if `fd` is invalid.
  static SharedMemory map(
    FileDescriptor fd, const std::string & path, size_t min_size_bytes, int flags);
  SharedMemory(FileDescriptor fd, const std::string & path, size_t size_bytes, int flags);
  void unmap() noexcept;
  /// Returns an errno.
  int try_reserve(uint64_t first, uint64_t bytes) const noexcept;
  [[noreturn]] void throw_no_space(uint64_t bytes) const;

  LastingDescriptor file_;
  std::string path_;
  std::byte * data_ = nullptr;
  size_t size_ = 0;
};

}  // namespace manycore
