// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/receive_thread_watcher.hpp"

#include <poll.h>

#include <cstdio>

#include "platform/blocked_signals.hpp"
#include "platform/lasting_descriptor.hpp"
#include "platform/os_process.hpp"
#include "transport/lifecycle/lifecycle.hpp"

namespace manycore {
namespace {

constexpr int restart_ms = 1000;  ///< after a failed start
constexpr int settle_ms = 1;      ///< while another process is starting it
constexpr int no_timeout_ms = -1;
constexpr int foreign_ms = 500;  ///< pidfds do not work across PID namespaces

/// Sleeps until the timeout or until the descriptor is readable; -1 disables either. The thread can
/// be cancelled here only. A descriptor to end it by could be closed by the program.
void sleep_cancellable(int timeout_ms, int fd = -1) {
  pollfd readable{fd, POLLIN, 0};
  pthread_setcancelstate(PTHREAD_CANCEL_ENABLE, nullptr);
  poll(&readable, 1, timeout_ms);
  pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr);
}

}  // namespace

ReceiveThreadWatcher::ReceiveThreadWatcher(Registry & registry, uint32_t cluster)
: registry_(registry), cluster_(cluster) {
  const BlockedSignals blocked;
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "manycore_watch");
}

ReceiveThreadWatcher::~ReceiveThreadWatcher() {
  pthread_cancel(thread_.native_handle());
  thread_.join();
}

/// The receive thread ends when the files are removed. If it was killed before, this thread detects
/// it.
bool ReceiveThreadWatcher::is_cut_off() {
  if (registry_.is_current()) {
    return false;
  }
  note_removal(registry_);
  const std::string & directory = registry_.paths().directory;
  std::fprintf(
    stderr,
    "[rmw_manycore] %s was removed while this process used it (systemd-logind does so at logout, "
    "if RemoveIPC is on: see 'manycore doctor'); restart this process\n",
    directory.c_str());
  return true;
}

bool ReceiveThreadWatcher::watch_once() {
  if (is_cut_off()) {
    return false;
  }
  ensure_receive_thread(registry_, cluster_);
  const Lifelines & lifelines = registry_.lifelines();
  const uint32_t line = receive_thread_line + cluster_;
  const ProcessIdentity receive_thread = lifelines.holder(line);
  if (!receive_thread.is_of_this_pid_namespace()) {
    sleep_cancellable(lifelines.is_held(line) ? foreign_ms : settle_ms);
    return true;
  }
  const LastingDescriptor pidfd(open_pidfd(receive_thread.pid));
  // The lifeline proves that the pid read above is still the receive thread's.
  const bool is_watched = lifelines.is_held(line) && pidfd.get() >= 0;
  sleep_cancellable(is_watched ? no_timeout_ms : settle_ms, pidfd.get());
  return true;
}

/// Not noexcept: cancellation unwinds the stack.
void ReceiveThreadWatcher::run() {
  pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, nullptr);
  bool reported = false;
  bool running = true;
  while (running) {
    try {
      running = watch_once();
      reported = false;
    } catch (const std::exception & error) {
      if (!reported) {
        std::fprintf(stderr, "[rmw_manycore] %s; trying again\n", error.what());
      }
      reported = true;
      sleep_cancellable(restart_ms);
    }
  }
}

}  // namespace manycore
