// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "platform/lifeline.hpp"

#include <pthread.h>

#include <condition_variable>
#include <cstdio>
#include <future>
#include <mutex>
#include <thread>

#include "platform/blocked_signals.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/file_lock.hpp"
#include "platform/fork_side.hpp"

namespace manycore {
namespace {

constexpr uint64_t lifelines_magic = 0x4d43'4c49'4645'4c4e;  // "MCLIFELN"
constexpr long no_wait_ns = 0;
constexpr int hold_timeout_ms = 10'000;

/// Locks the mutex of a line that is not held. The caller excludes others that try to hold it, as
/// RobustMutex requires.
void lock(RobustMutex & mutex) {
  switch (mutex.lock(no_wait_ns)) {
    case RobustMutex::Outcome::locked:
      return;
    case RobustMutex::Outcome::owner_died:
      mutex.mark_consistent();
      return;
    case RobustMutex::Outcome::timed_out:
      throw Error(ErrorCode::corrupt, "a lifeline is damaged");
  }
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
    timespec left = to_timespec(enough_ms * ns_per_s / 1000);  // no descriptor left for a pidfd
    while (nanosleep(&left, &left) != 0) {
    }
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

/// The thread never unlocks the mutex: the kernel releases it when the thread ends, by intent or by
/// a kill.
struct HeldLifeline::Holder {
  explicit Holder(std::shared_ptr<SharedMemory> memory_, Lifeline & line_)
  : memory(std::move(memory_)), line(line_) {}

  void hold();
  void let_go();

  std::shared_ptr<SharedMemory> memory;
  Lifeline & line;
  ForkSide side;
  std::promise<bool> is_held;
  std::mutex mutex;
  std::condition_variable changed;
  bool ends = false;
  std::thread thread;
};

void HeldLifeline::Holder::hold() {
  pthread_setname_np(pthread_self(), "manycore_life");
  try {
    const bool held = !line.mutex.is_locked();
    if (held) {
      // Before it is held: a line that is held names its holder.
      const ProcessIdentity own = ProcessIdentity::own();
      line.start_time = own.start_time;
      line.pid_namespace = own.pid_namespace;
      line.pid = own.pid;
      lock(line.mutex);
    }
    is_held.set_value(held);
    if (!held) {
      return;
    }
  } catch (...) {
    is_held.set_exception(std::current_exception());
    return;
  }
  std::unique_lock<std::mutex> lock(mutex);
  changed.wait(lock, [this] { return ends; });
}

void HeldLifeline::Holder::let_go() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    ends = true;
  }
  changed.notify_one();
  thread.join();
}

HeldLifeline::HeldLifeline(std::unique_ptr<Holder> holder) : holder_(std::move(holder)) {}

HeldLifeline::HeldLifeline(HeldLifeline &&) noexcept = default;

HeldLifeline & HeldLifeline::operator=(HeldLifeline && other) noexcept {
  std::swap(holder_, other.holder_);
  return *this;
}

HeldLifeline::~HeldLifeline() {
  if (!holder_) {
    return;
  }
  if (holder_->side.is_inherited()) {
    // The thread belongs to the parent, and a mutex it holds cannot be destroyed here.
    holder_.release();
    return;
  }
  holder_->line.pid = 0;  // this process lives on without the line
  holder_->let_go();
}

/// Creates the file under another name and renames it when it is complete: a process killed in
/// between leaves a directory without lifelines, which the next process removes.
void Lifelines::create(const std::string & path, uint32_t count) {
  const uint64_t bytes = sizeof(Header) + uint64_t{count} * sizeof(Lifeline);
  const std::string unfinished = path + ".new";
  const SharedMemory memory = SharedMemory::create(unfinished, bytes);
  memory.reserve(0, bytes);
  for (uint32_t line = 0; line < count; ++line) {
    memory.at<Lifeline>(sizeof(Header) + uint64_t{line} * sizeof(Lifeline)).mutex.initialize();
  }
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
  if (
    header.magic.load(std::memory_order_acquire) != lifelines_magic ||
    header.count > lifelines.memory_->size() / sizeof(Lifeline) - 1) {
    throw Error(
      ErrorCode::corrupt, path +
                            " is damaged, or of another version of rmw_manycore; stop the "
                            "platform's nodes and run 'manycore clean'");
  }
  return lifelines;
}

std::optional<HeldLifeline> Lifelines::try_hold(uint32_t line) const {
  // One process at a time tries; the kernel opens the file to the next one only after the last
  // thread of a killed one has ended.
  const std::optional<FileLock> others = FileLock::acquire_existing(path_, hold_timeout_ms);
  if (!others) {
    throw Error(ErrorCode::system, path_ + " was removed; try again");
  }
  auto holder = std::make_unique<HeldLifeline::Holder>(memory_, at(line));
  {
    const BlockedSignals blocked;
    holder->thread = std::thread([&holder = *holder] { holder.hold(); });
  }
  try {
    if (holder->is_held.get_future().get()) {
      return HeldLifeline(std::move(holder));
    }
  } catch (...) {
    holder->thread.join();
    throw;
  }
  holder->thread.join();
  return std::nullopt;
}

bool Lifelines::is_locked(uint32_t line) const { return at(line).mutex.is_locked(); }

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
  const pid_t thread = at(line).mutex.owner();
  const ProcessIdentity last = holder(line);
  if (
    thread != 0 && last.pid > 0 && last.is_of_this_pid_namespace() &&
    !(ProcessIdentity::of(last.pid) == last) && holder(line) == last) {
    at(line).mutex.mark_owner_died(thread);
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

uint32_t Lifelines::count() const noexcept { return memory_->at<Header>(0).count; }

Lifeline & Lifelines::at(uint32_t line) const {
  if (line >= count()) {
    throw Error(ErrorCode::corrupt, "there is no lifeline " + std::to_string(line));
  }
  return memory_->at<Lifeline>(sizeof(Header) + uint64_t{line} * sizeof(Lifeline));
}

}  // namespace manycore
