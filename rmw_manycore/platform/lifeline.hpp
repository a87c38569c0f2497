// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "platform/process_identity.hpp"
#include "platform/robust_mutex.hpp"
#include "platform/shared_memory.hpp"

namespace manycore {

/// One line of a file of lifelines. Its mutex is held by a thread that does nothing else: the
/// kernel marks the mutex when the thread ends, whatever ended it.
struct Lifeline {
  RobustMutex mutex;
  /// ProcessIdentity of the holder, or of the last one; pid 0 once it let go.
  std::atomic<pid_t> pid;
  std::atomic<uint64_t> start_time;
  std::atomic<uint64_t> pid_namespace;
};
static_assert(sizeof(Lifeline) == 64);

/// A line held by this process, from construction to destruction. A child of fork() holds nothing,
/// and lets nothing go.
class HeldLifeline {
public:
  HeldLifeline(HeldLifeline &&) noexcept;
  HeldLifeline & operator=(HeldLifeline &&) noexcept;
  ~HeldLifeline();

private:
  friend class Lifelines;
  struct Holder;
  explicit HeldLifeline(std::unique_ptr<Holder> holder);
  std::unique_ptr<Holder> holder_;
};

/// A file of lifelines: proof that the processes which hold a line live. It needs no descriptor
/// that stays open, is not inherited by fork(), holds across PID namespaces and within one process.
class Lifelines {
public:
  static void create(const std::string & path, uint32_t count);
  /// Throws Error{corrupt} for what is no file of lifelines.
  static Lifelines open(const std::string & path);

  /// Empty when the line is held already. Throws Error{corrupt} on a damaged line and
  /// std::system_error when there is no room for a thread.
  std::optional<HeldLifeline> try_hold(uint32_t line) const;
  /// False once the holder has ended. Of a holder in another PID namespace nothing tells that the
  /// last of its threads has stopped, a moment after the one that held the line.
  bool is_held(uint32_t line) const;
  bool is_any_held() const;
  /// As SharedMemory::is_file().
  bool is_file(const std::string & path) const noexcept { return memory_->is_file(path); }
  /// The process that holds the line, or held it last.
  ProcessIdentity holder(uint32_t line) const;

private:
  struct Header;
  explicit Lifelines(SharedMemory memory);
  Lifeline & at(uint32_t line) const;
  uint32_t count() const noexcept;

  std::shared_ptr<SharedMemory> memory_;
};

}  // namespace manycore
