// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/receive_thread_watcher.hpp"

#include <poll.h>
#include <sys/eventfd.h>

#include <cstdio>

#include "platform/blocked_signals.hpp"
#include "platform/os_process.hpp"
#include "transport/lifecycle/lifecycle.hpp"

namespace manycore {
namespace {

constexpr int retry_ms = 1000;  ///< after a start that failed
constexpr int settle_ms = 1;    ///< while another process is starting it
constexpr int for_ever_ms = -1;
constexpr int foreign_ms = 500;  ///< no pidfd tells of an end in another PID namespace

}  // namespace

ReceiveThreadWatcher::ReceiveThreadWatcher(Registry & registry, uint32_t cluster)
: registry_(registry), cluster_(cluster), stop_(eventfd(0, EFD_CLOEXEC)) {
  if (!stop_) {
    throw_errno("cannot create an eventfd");
  }
  const BlockedSignals blocked;
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "manycore_watch");
}

ReceiveThreadWatcher::~ReceiveThreadWatcher() {
  eventfd_write(stop_.get(), 1);
  thread_.join();
}

bool ReceiveThreadWatcher::stopped_within(int timeout_ms, int other_fd) const noexcept {
  pollfd fds[2] = {{stop_.get(), POLLIN, 0}, {other_fd, POLLIN, 0}};
  while (poll(fds, other_fd >= 0 ? 2 : 1, timeout_ms) < 0) {
  }
  return (fds[0].revents & POLLIN) != 0;
}

/// The receive thread ends when the files go; if it was killed before, this thread notices.
bool ReceiveThreadWatcher::is_cut_off() {
  if (registry_.is_current()) {
    return false;
  }
  note_removal(registry_);
  const std::string & directory = registry_.paths().directory;
  std::fprintf(
    stderr,
    "[rmw_manycore] %s was removed while this process used it (systemd-logind does so at logout, "
    "if RemoveIPC is on: see 'manycore doctor'); start this process again\n",
    directory.c_str());
  return true;
}

bool ReceiveThreadWatcher::watch_once() {
  if (is_cut_off()) {
    return false;
  }
  ensure_receive_thread(registry_.paths(), cluster_);
  const Lifelines & lifelines = registry_.lifelines();
  const uint32_t line = receive_thread_line + cluster_;
  const ProcessIdentity receive_thread = lifelines.holder(line);
  if (!receive_thread.is_of_this_pid_namespace()) {
    return !stopped_within(lifelines.is_held(line) ? foreign_ms : settle_ms, -1);
  }
  const FileDescriptor pidfd = open_pidfd(receive_thread.pid);
  // The lifeline proves that the pid, read before, is still the receive thread's.
  if (!pidfd || !lifelines.is_held(line)) {
    return !stopped_within(settle_ms, -1);
  }
  return !stopped_within(for_ever_ms, pidfd.get());
}

void ReceiveThreadWatcher::run() noexcept {
  bool reported = false;
  bool running = true;
  while (running) {
    try {
      running = watch_once();
    } catch (const std::exception & error) {
      if (!reported) {
        std::fprintf(stderr, "[rmw_manycore] %s\n", error.what());
      }
      reported = true;
      running = !stopped_within(retry_ms, -1);
    }
  }
}

}  // namespace manycore
