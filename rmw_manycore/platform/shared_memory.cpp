// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/shared_memory.hpp"

#include <fcntl.h>
#include <linux/mempolicy.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "platform/error.hpp"
#include "platform/private_directory.hpp"

namespace manycore {
namespace {

constexpr uint64_t step_bytes = 4 << 20;  ///< takes about 3 ms to back
constexpr size_t max_numa_nodes = 1024;   ///< of the kernel, at most

uint64_t page_floor(uint64_t x) { return x & ~(page_bytes - 1); }
uint64_t page_ceil(uint64_t x) { return page_floor(x + page_bytes - 1); }

}  // namespace

SharedMemory::SharedMemory(
  FileDescriptor fd, const std::string & path, size_t size_bytes, int flags)
: file_(std::move(fd), path, flags), path_(path), size_(size_bytes) {
  void * const mapped =
    mmap(nullptr, size_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, file_.get(), 0);
  if (mapped == MAP_FAILED) {
    throw_errno("cannot map " + path);
  }
  // Keep the platform's memory out of core dumps.
  madvise(mapped, size_bytes, MADV_DONTDUMP);
  data_ = static_cast<std::byte *>(mapped);
}

SharedMemory::SharedMemory(SharedMemory && other) noexcept { *this = std::move(other); }

SharedMemory & SharedMemory::operator=(SharedMemory && other) noexcept {
  std::swap(file_, other.file_);
  std::swap(path_, other.path_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

SharedMemory::~SharedMemory() { unmap(); }

void SharedMemory::unmap() noexcept {
  if (data_ != nullptr) {
    munmap(data_, size_);
  }
}

SharedMemory SharedMemory::create(const std::string & path, size_t size_bytes) {
  FileDescriptor fd = open_private_file(path, O_RDWR | O_CREAT | O_EXCL, 0600);
  if (!fd) {
    throw_errno("cannot create " + path);
  }
  if (ftruncate(fd.get(), static_cast<off_t>(size_bytes)) != 0) {
    throw_errno("cannot size " + path);
  }
  return SharedMemory(std::move(fd), path, size_bytes, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
}

SharedMemory SharedMemory::open(const std::string & path, size_t min_size_bytes) {
  constexpr int flags = O_RDWR | O_CLOEXEC | O_NOFOLLOW;
  return map(open_private_file(path, flags), path, min_size_bytes, flags);
}

SharedMemory SharedMemory::attach(const std::string & shared_path) {
  constexpr int flags = O_RDWR | O_CLOEXEC;  // the path is a symbolic link in /proc
  FileDescriptor fd(::open(shared_path.c_str(), flags));
  if (fd) {
    require_own_file(fd, shared_path);
  }
  return map(std::move(fd), shared_path, 1, flags);
}

SharedMemory SharedMemory::map(
  FileDescriptor fd, const std::string & path, size_t min_size_bytes, int flags) {
  if (!fd) {
    throw_errno("cannot open " + path);
  }
  struct stat status {};
  if (fstat(fd.get(), &status) != 0) {
    throw_errno("cannot examine " + path);
  }
  if (!S_ISREG(status.st_mode) || static_cast<size_t>(status.st_size) < min_size_bytes) {
    throw Error(
      ErrorCode::corrupt, path + " is truncated or not a segment (" +
                            std::to_string(status.st_size) + " bytes, expected at least " +
                            std::to_string(min_size_bytes) + "); remove it with 'manycore clean'");
  }
  return SharedMemory(std::move(fd), path, static_cast<size_t>(status.st_size), flags);
}

SharedMemory SharedMemory::anonymous(const std::string & label, size_t size_bytes) {
  FileDescriptor fd(memfd_create(label.c_str(), MFD_CLOEXEC));
  if (!fd) {
    throw_errno("cannot create shared memory for " + label);
  }
  if (ftruncate(fd.get(), static_cast<off_t>(size_bytes)) != 0) {
    throw_errno("cannot size the shared memory for " + label);
  }
  SharedMemory memory(std::move(fd), label, size_bytes, O_RDWR | O_CLOEXEC);
  memory.reserve(0, size_bytes);
  return memory;
}

std::string SharedMemory::shared_path() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(file_.get());
}

FileSystemRoom SharedMemory::file_system_room() const noexcept {
  struct statvfs fs {};
  fstatvfs(file_.get(), &fs);
  return {uint64_t{fs.f_bavail} * fs.f_frsize, uint64_t{fs.f_blocks} * fs.f_frsize};
}

int SharedMemory::try_reserve(uint64_t first, uint64_t bytes) const noexcept {
  const int fd = file_.get();
  int error = fd < 0 ? errno : 0;
  do {
    error =
      fd < 0 ? error : posix_fallocate(fd, static_cast<off_t>(first), static_cast<off_t>(bytes));
  } while (error == EINTR);
  return error;
}

void SharedMemory::throw_no_space(uint64_t bytes) const {
  const FileSystemRoom room = file_system_room();
  throw Error(
    ErrorCode::no_space,
    "no room for " + std::to_string(bytes) + " bytes in " + path_ + ": " +
      std::to_string(room.free_bytes) + " of " + std::to_string(room.total_bytes) +
      " bytes are free; enlarge its file system (mount -o remount,size=...) or lower "
      "topic_dsm_size");
}

void SharedMemory::reserve(uint64_t offset, uint64_t length) const {
  const uint64_t first = page_floor(offset);
  const uint64_t bytes = page_ceil(offset + length) - first;
  if (try_reserve(first, bytes) != 0) {
    throw_no_space(bytes);
  }
}

void SharedMemory::reserve_and_populate(uint64_t offset, uint64_t length) const {
  const uint64_t first = page_floor(offset);
  const uint64_t end = page_ceil(offset + length);
  for (uint64_t step = first; step < end; step += step_bytes) {
    const uint64_t bytes = std::min(step_bytes, end - step);
    if (try_reserve(step, bytes) != 0) {
      throw_no_space(end - first);
    }
    populate(step, bytes);
  }
}

void SharedMemory::populate(uint64_t offset, uint64_t length) const noexcept {
  const uint64_t first = page_floor(offset);
  // Kernels before 5.14 reject the advice; the first access then maps each page.
  madvise(data_ + first, page_ceil(offset + length) - first, MADV_POPULATE_WRITE);
}

bool SharedMemory::prefer_numa_node(int node) const noexcept {
  constexpr size_t word_bits = 8 * sizeof(unsigned long);
  std::array<unsigned long, max_numa_nodes / word_bits> nodes{};
  if (node < 0 || static_cast<size_t>(node) >= max_numa_nodes) {
    return false;
  }
  nodes[static_cast<size_t>(node) / word_bits] = 1ul << (static_cast<size_t>(node) % word_bits);
  // The policy is of the file in tmpfs, not of this mapping. MPOL_BIND would kill a process when
  // the node is full. The kernel reads one bit less than it is given.
  return syscall(SYS_mbind, data_, size_, MPOL_PREFERRED, nodes.data(), max_numa_nodes + 1, 0u) ==
         0;
}

bool SharedMemory::copy_out(uint64_t offset, void * to, size_t length) const noexcept {
  const int fd = file_.get();
  return fd >= 0 &&
         pread(fd, to, length, static_cast<off_t>(offset)) == static_cast<ssize_t>(length);
}

void SharedMemory::release(uint64_t offset, uint64_t length) const noexcept {
  const uint64_t first = page_ceil(offset);
  const uint64_t end = page_floor(offset + length);
  for (uint64_t step = first; step < end; step += step_bytes) {
    madvise(data_ + step, std::min(step_bytes, end - step), MADV_REMOVE);
  }
}

}  // namespace manycore
