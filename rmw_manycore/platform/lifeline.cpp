// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/lifeline.hpp"

#include <cstdio>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/file_lock.hpp"
#include "platform/wall_sleep.hpp"

namespace manycore {
namespace {

constexpr uint64_t lifelines_magic = 0x4d43'4c49'4645'4c4e;  // "MCLIFELN"
constexpr int hold_timeout_ms = 10'000;

pid_t thread_in(const Lifeline & line) {
  return static_cast<pid_t>(line.thread.load(std::memory_order_acquire) & FUTEX_TID_MASK);
}

/// When a process is killed, its threads end one by one in no particular order. The thread that
/// held the lifeline has ended, but others may still be running on their CPUs. They stop at the
/// next interrupt or at the end of their system call; system calls that return memory are made
/// under the registry lock. The wait is bounded, because a process that called exec() keeps its
/// pid.
void wait_for_stragglers(const ProcessIdentity & dying) {
  constexpr int enough_ms = 10;
  try {
    dying.wait_for_end(enough_ms);
  } catch (const Error &) {
    wall_sleep_for(std::chrono::milliseconds(enough_ms));  // no descriptor left for a pidfd
  }
}

}  // namespace

/// First line of the file. Its layout is the same in all versions, so that each version can tell
/// whether a platform of another version lives. `magic` is stored last.
struct Lifelines::Header {
  std::atomic<uint64_t> magic;
  uint32_t count;
  char reserved[52];
};

HeldLifeline & HeldLifeline::operator=(HeldLifeline && other) noexcept {
  std::swap(memory_, other.memory_);
  std::swap(line_, other.line_);
  std::swap(thread_, other.thread_);
  std::swap(side_, other.side_);
  return *this;
}

HeldLifeline::~HeldLifeline() {
  if (!thread_) {
    return;
  }
  if (side_.is_inherited()) {
    thread_.release();  // it runs in the parent
    return;
  }
  line_->pid = 0;  // this process lives on without the line
  thread_.reset();
}

/// Creates the file under another name and renames it when it is complete: a process killed in
/// between leaves a directory without lifelines, which the next process removes.
void Lifelines::create(const std::string & path, uint32_t count) {
  const uint64_t bytes = sizeof(Header) + uint64_t{count} * sizeof(Lifeline);
  const std::string unfinished = path + ".new";
  const SharedMemory memory = SharedMemory::create(unfinished, bytes);
  memory.reserve(0, bytes);
  auto & header = memory.at<Header>(0);
  header.count = count;
  header.magic.store(lifelines_magic, std::memory_order_release);
  if (rename(unfinished.c_str(), path.c_str()) != 0) {
    throw_errno("cannot create " + path);
  }
}

Lifelines::Lifelines(const std::string & path, SharedMemory memory)
: path_(path), memory_(std::make_shared<SharedMemory>(std::move(memory))) {}

Lifelines Lifelines::open(const std::string & path) {
  static_assert(sizeof(Header) == sizeof(Lifeline));
  Lifelines lifelines(path, SharedMemory::open(path, sizeof(Header)));
  const Header & header = lifelines.memory_->at<Header>(0);
  lifelines.count_ = header.count;
  if (
    header.magic.load(std::memory_order_acquire) != lifelines_magic ||
    lifelines.count_ > lifelines.memory_->size() / sizeof(Lifeline) - 1) {
    throw Error(
      ErrorCode::corrupt, path +
                            " is damaged, or of another version of rmw_manycore; stop the "
                            "platform's nodes and run 'manycore clean'");
  }
  return lifelines;
}

std::optional<HeldLifeline> Lifelines::try_hold(
  uint32_t number, std::unique_ptr<LifeThread> & thread) const {
  // One process at a time tries; the kernel opens the file to the next one only after the last
  // thread of a killed one has ended.
  const std::optional<FileLock> others = FileLock::acquire_existing(path_, hold_timeout_ms);
  if (!others) {
    throw Error(ErrorCode::system, path_ + " was removed; try again");
  }
  if (is_locked(number)) {
    return std::nullopt;
  }
  // Before it is held: a line that is held names its holder.
  Lifeline & line = at(number);
  const ProcessIdentity own = ProcessIdentity::own();
  line.start_time = own.start_time;
  line.pid_namespace = own.pid_namespace;
  line.pid = own.pid;
  thread->hold(line.thread);
  return HeldLifeline(memory_, line, std::move(thread));
}

std::optional<HeldLifeline> Lifelines::try_hold(uint32_t line) const {
  auto thread = std::make_unique<LifeThread>();
  return try_hold(line, thread);
}

bool Lifelines::is_locked(uint32_t line) const { return thread_in(at(line)) != 0; }

bool Lifelines::is_held(uint32_t line) const {
  if (is_locked(line)) {
    return true;
  }
  const ProcessIdentity last = holder(line);
  if (last.pid != 0 && last.is_of_this_pid_namespace()) {
    wait_for_stragglers(last);
  }
  return false;
}

void Lifelines::release_if_abandoned(uint32_t line) const {
  uint32_t seen = at(line).thread.load();
  const ProcessIdentity last = holder(line);
  if (
    (seen & FUTEX_TID_MASK) != 0 && last.pid > 0 && last.is_of_this_pid_namespace() &&
    !(ProcessIdentity::of(last.pid) == last) && holder(line) == last) {
    at(line).thread.compare_exchange_strong(seen, FUTEX_OWNER_DIED);
  }
}

bool Lifelines::is_any_held() const {
  for (uint32_t line = 0; line < count(); ++line) {
    release_if_abandoned(line);
    if (is_held(line)) {
      return true;
    }
  }
  return false;
}

ProcessIdentity Lifelines::holder(uint32_t line) const {
  const Lifeline & lifeline = at(line);
  return {lifeline.pid.load(), lifeline.start_time.load(), lifeline.pid_namespace.load()};
}

Lifeline & Lifelines::at(uint32_t line) const {
  if (line >= count()) {
    throw Error(ErrorCode::corrupt, "there is no lifeline " + std::to_string(line));
  }
  return memory_->at<Lifeline>(sizeof(Header) + uint64_t{line} * sizeof(Lifeline));
}

}  // namespace manycore
