// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "platform/fork_side.hpp"
#include "platform/life_thread.hpp"
#include "platform/process_identity.hpp"
#include "platform/shared_memory.hpp"

namespace manycore {

/// One line of a lifeline file. A LifeThread of its holder holds `thread`.
struct Lifeline {
  FutexWord thread;  ///< its number in its PID namespace, and the kernel's flags
  uint32_t reserved[9];
  /// ProcessIdentity of the current or last holder; pid 0 after the holder released the line.
  std::atomic<pid_t> pid;
  std::atomic<uint64_t> start_time;
  std::atomic<uint64_t> pid_namespace;
};
static_assert(sizeof(Lifeline) == 64 && offsetof(Lifeline, pid) == 40);

/// A line held by this process during the object's lifetime. A child of fork() neither holds nor
/// releases it.
class HeldLifeline {
public:
  HeldLifeline(HeldLifeline &&) noexcept = default;
  HeldLifeline & operator=(HeldLifeline && other) noexcept;
  ~HeldLifeline();

private:
  friend class Lifelines;
  HeldLifeline(
    std::shared_ptr<SharedMemory> memory, Lifeline & line, std::unique_ptr<LifeThread> thread)
  : memory_(std::move(memory)), line_(&line), thread_(std::move(thread)) {}

  std::shared_ptr<SharedMemory> memory_;
  Lifeline * line_;
  std::unique_ptr<LifeThread> thread_;
  ForkSide side_;
};

/// A file of lifelines, which prove that the processes that hold them live. Needs no open
/// descriptor, is not inherited by fork(), and works across PID namespaces and within one process.
class Lifelines {
public:
  static void create(const std::string & path, uint32_t count);
  /// Throws Error{corrupt} if the file is not a lifeline file.
  static Lifelines open(const std::string & path);

  /// Empty if the line is already held; otherwise takes the thread, which was started before so
  /// that no other process waits for it. Throws Error{system} if the file was removed.
  std::optional<HeldLifeline> try_hold(uint32_t line, std::unique_ptr<LifeThread> & thread) const;
  /// As above. Throws std::system_error if no thread can be started.
  std::optional<HeldLifeline> try_hold(uint32_t line) const;
  /// False once the holder has ended. For a holder in another PID namespace, its last threads may
  /// still be running for a moment after the one that held the line.
  bool is_held(uint32_t line) const;
  /// As is_held(), but without a system call: a single load. For a holder in any PID namespace, its
  /// last threads may still be running for a moment after this returns false.
  bool is_locked(uint32_t line) const;
  /// Takes abandoned lines into account.
  bool is_any_held() const;
  uint32_t count() const noexcept { return count_; }
  /// Releases a line whose holder does not exist any more, though the kernel has not released it:
  /// kernels before 5.18 may fail to for a process that is killed as memory runs out. Without
  /// effect for a holder of another PID namespace.
  void release_if_abandoned(uint32_t line) const;
  /// See SharedMemory::is_file().
  bool is_file(const std::string & path) const noexcept { return memory_->is_file(path); }
  /// The current or last holder of the line.
  ProcessIdentity holder(uint32_t line) const;

private:
  struct Header;
  Lifelines(const std::string & path, SharedMemory memory);
  Lifeline & at(uint32_t line) const;

  std::string path_;
  std::shared_ptr<SharedMemory> memory_;
  uint32_t count_ = 0;  ///< as read when the file was opened: memory may be damaged afterwards
};

}  // namespace manycore
