// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/reaper.hpp"

#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <utility>

#include "platform/os_process.hpp"
#include "platform/private_directory.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/lifecycle/trace_saver.hpp"
#include "transport/matching/sweeping.hpp"

namespace manycore {
namespace {

constexpr int for_ever_ms = -1;
constexpr int retry_ms = 1000;
constexpr int unwatched_ms = 500;
constexpr uint64_t rescan_key = 0;  ///< pid 0 never occurs
constexpr uint64_t files_key = UINT64_MAX;

void add_to_poll(int poll, int fd, uint64_t key) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = key;
  if (epoll_ctl(poll, EPOLL_CTL_ADD, fd, &event) != 0) {
    throw_errno("cannot watch a descriptor");
  }
}

/// An inotify descriptor that reports removed files of a directory; empty if the limit of such
/// descriptors is reached.
FileDescriptor watch_files_of(const std::string & directory) {
  FileDescriptor files(inotify_init1(IN_CLOEXEC | IN_NONBLOCK));
  constexpr uint32_t gone = IN_DELETE | IN_MOVED_FROM | IN_DELETE_SELF | IN_MOVE_SELF;
  return files && inotify_add_watch(files.get(), directory.c_str(), gone) >= 0 ? std::move(files)
                                                                               : FileDescriptor();
}

void drain(const FileDescriptor & descriptor) {
  char skipped[4096];
  while (read(descriptor.get(), skipped, sizeof skipped) > 0) {
  }
}

/// True if another user's directory, or a link, lies where one of this user was.
bool is_refused(const std::string & directory) {
  try {
    PrivateDirectory::open(directory);
    return false;
  } catch (const Error & error) {
    return error.code() == ErrorCode::permission;
  }
}

/// Removes the platform if no process uses it. True if this receive thread has nothing left to
/// serve.
bool end_if_unused(Registry & registry) {
  if (access(registry.paths().user_directory.c_str(), F_OK) != 0) {
    note_removal(registry);
    return true;
  }
  if (is_refused(registry.paths().user_directory) || is_refused(registry.paths().directory)) {
    return !is_in_use(registry);  // what lies there is not ours to remove
  }
  bool ends = false;
  under_join_lock(registry.paths(), [&] {
    if (!registry.is_current()) {
      note_removal(registry);
      remove_if_unused(registry);  // what is left of it, or a process killed meanwhile left
      ends = true;
    } else {
      ends = remove_if_unused(registry);
    }
  });
  return ends;
}

}  // namespace

void exit_if_unused(Registry & registry) {
  // One thread at a time: _exit() in one thread would end the other midway, and leave the directory
  // that its join lock created.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> guard(mutex);
  if (end_if_unused(registry)) {
    _exit(0);
  }
}

Reaper::Reaper(Registry & registry, uint32_t cluster)
: registry_(registry),
  cluster_(cluster),
  poll_(epoll_create1(EPOLL_CLOEXEC)),
  event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
  files_(watch_files_of(registry.paths().directory)) {
  if (!poll_ || !event_) {
    throw_errno("cannot create the reaper's descriptors");
  }
  add_to_poll(poll_.get(), event_.get(), rescan_key);
  if (files_) {
    add_to_poll(poll_.get(), files_.get(), files_key);
  }
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "manycore_reaper");
}

Reaper::~Reaper() {
  running_ = false;
  rescan();
  thread_.join();
}

void Reaper::rescan(uint32_t process) noexcept {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (process < process_capacity) {
      joined_.set(process);
    } else {
      must_check_all_ = true;
    }
  }
  eventfd_write(event_.get(), 1);
}

void Reaper::watch(uint32_t line) {
  const ProcessIdentity holder = registry_.lifelines().holder(line);
  if (holder.pid <= 0) {
    return;
  }
  // A pid of another PID namespace may belong to a different process here.
  const bool is_watched =
    holder.is_of_this_pid_namespace() &&
    (holder.pid == getpid() || watched_.count(holder.pid) != 0 || watch_end_of(holder.pid));
  if (!is_watched) {
    some_unwatched_ = some_unwatched_ || registry_.lifelines().is_held(line);
  }
}

/// No thread of the process with this pid runs any more; see Lifelines::release_if_abandoned().
void Reaper::release_abandoned(pid_t pid) {
  const Lifelines & lifelines = registry_.lifelines();
  for (uint32_t line = 0; line < lifeline_count; ++line) {
    const ProcessIdentity holder = lifelines.holder(line);
    if (holder.pid == pid && holder.is_of_this_pid_namespace()) {
      lifelines.release_if_abandoned(line);
      RobustMutex & held = registry_.header().badges[line].held;
      const pid_t thread = held.owner();
      if (thread != 0 && !lifelines.is_locked(line)) {
        held.mark_owner_died(thread);
      }
    }
  }
}

bool Reaper::watch_end_of(pid_t pid) {
  try {
    FileDescriptor pidfd = open_pidfd(pid);
    if (!pidfd) {
      return true;
    }
    add_to_poll(poll_.get(), pidfd.get(), static_cast<uint64_t>(pid));
    watched_.emplace(pid, std::move(pidfd));
    return true;
  } catch (const Error &) {
    return false;
  }
}

/// A cluster without a receive thread is watched by all reapers. So is a cluster whose receive
/// thread is not watched, because its end would go unnoticed; once it is watched, the lifeline is
/// checked.
bool Reaper::is_ours(uint32_t cluster) const {
  if (cluster == cluster_) {
    return true;
  }
  const Lifelines & lifelines = registry_.lifelines();
  const uint32_t line = receive_thread_line + cluster;
  const ProcessIdentity holder = lifelines.holder(line);
  return !holder.is_of_this_pid_namespace() || watched_.count(holder.pid) == 0 ||
         !lifelines.is_held(line);
}

void Reaper::watch_members() {
  some_unwatched_ = false;
  const uint64_t present = registry_.header().clusters_present.load();
  for (uint32_t id = 1; id <= max_clusters; ++id) {
    if ((present >> (id - 1) & 1) != 0 && id != cluster_) {
      watch(receive_thread_line + id);
    }
  }
  for (uint32_t slot = 0; slot < registry_.processes().high_water(); ++slot) {
    if (registry_.processes().is_live(slot) && is_ours(registry_.processes()[slot].cluster)) {
      watch(slot);
    }
  }
  // The configurator keeps the platform without any process, and may be killed last.
  if (registry_.lifelines().is_held(configurator_line)) {
    watch(configurator_line);
  }
}

/// The usual case: watches only the processes that joined, so that a join does not cost a check of
/// every process. Watches first, then checks the lifeline: a process that died before it was
/// watched is found by a check of all processes.
bool Reaper::watch_joined() noexcept {
  std::bitset<process_capacity> joined;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (must_check_all_) {
      return false;
    }
    joined = std::exchange(joined_, {});
  }
  try {
    wait_for_joining();
    for (uint32_t slot = 0; slot < process_capacity; ++slot) {
      if (joined.test(slot) && !watch_one(slot)) {
        return false;
      }
    }
    return !some_unwatched_;
  } catch (const std::exception &) {
    return false;  // the lock stayed taken
  }
}

/// Returns false if the process is dead, or if another one had its pid: a program that executed
/// this one, which no pidfd reports.
bool Reaper::watch_one(uint32_t process) {
  watch(process);
  const auto & processes = registry_.processes();
  const pid_t pid = registry_.lifelines().holder(process).pid;
  for (uint32_t slot = 0; slot < processes.high_water(); ++slot) {
    if (slot != process && processes.is_live(slot) && processes[slot].pid == pid) {
      return false;
    }
  }
  return !processes.is_live(process) || registry_.lifelines().is_held(process);
}

/// Returns once the process that sent the message has joined: it holds the registry lock from
/// before it sends the message until its slot is live.
void Reaper::wait_for_joining() { const Registry::Lock lock(registry_); }

/// Watches first: reap_dead() then finds the members that died before they were watched.
bool Reaper::watch_and_reap() {
  // A predecessor, or an earlier attempt that failed, may have reaped without notifying.
  if (std::exchange(graph_may_have_changed_, true)) {
    registry_.graph_changed();
  }
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    joined_.reset();
    must_check_all_ = false;
  }
  wait_for_joining();
  watch_members();
  const uint32_t dead = reap_dead(registry_, cluster_);
  if (dead != 0 || some_ended_) {  // or a receive thread did
    remove_unfinished_traces(registry_);
  }
  empty_hands_of_receive_threads(registry_);
  is_any_in_use_ = sweeping::sweep_all(registry_);
  if (dead != 0) {
    registry_.graph_changed();
  }
  graph_may_have_changed_ = false;
  return dead != 0;
}

bool Reaper::wait_for_end(int timeout_ms) {
  epoll_event events[16];
  const int count = epoll_wait(poll_.get(), events, 16, timeout_ms);
  bool some_ended = false;
  for (int i = 0; i < count; ++i) {
    if (events[i].data.u64 == rescan_key) {
      eventfd_t ignored = 0;
      eventfd_read(event_.get(), &ignored);
    } else if (events[i].data.u64 == files_key) {
      drain(files_);
      some_ended = true;  // the platform is gone with its files
    } else {
      const auto pid = static_cast<pid_t>(events[i].data.u64);
      watched_.erase(pid);
      release_abandoned(pid);
      some_ended = true;
    }
  }
  return some_ended;
}

int Reaper::timeout_ms() const noexcept {
  if (some_unwatched_ || !files_) {
    return unwatched_ms;
  }
  return is_any_in_use_ ? retry_ms : for_ever_ms;
}

int Reaper::try_to_reap() noexcept {
  try {
    some_ended_ = watch_and_reap() || some_ended_;
    return timeout_ms();
  } catch (const std::exception &) {
    // The lock stayed taken, an entry is damaged, or the platform's files, which a repair needs,
    // are gone.
    some_ended_ = true;
    return retry_ms;
  }
}

int Reaper::try_to_end(int timeout_ms) noexcept {
  try {
    if (some_ended_ || !files_) {
      exit_if_unused(registry_);
    }
    some_ended_ = false;
    return timeout_ms;
  } catch (const std::exception &) {
    return retry_ms;  // the join lock stayed taken
  }
}

void Reaper::run() noexcept {
  while (running_) {
    const int timeout_ms = try_to_end(try_to_reap());
    do {
      some_ended_ = wait_for_end(timeout_ms) || some_ended_;
    } while (running_ && timeout_ms == for_ever_ms && !some_ended_ && watch_joined());
  }
}

}  // namespace manycore
