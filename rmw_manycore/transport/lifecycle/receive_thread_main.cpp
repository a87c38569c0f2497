// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// manycore_receive_thread PLATFORM CLUSTER: the receive thread of one cluster. Started by the first
// process of the cluster, and by each process that detects its death. Not meant to be started by
// hand.

#include <sys/prctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "platform/os_process.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/lifecycle/reaper.hpp"
#include "transport/movers/movers.hpp"
#include "transport/notification/receive_thread.hpp"

namespace manycore {
namespace {

void serve(const std::string & platform, uint32_t id, Daemon & daemon) {
  const PlatformPaths paths = PlatformPaths::of(platform);
  Registry registry(paths);
  Cluster & cluster = registry.clusters().at(id);
  Movers movers(registry, id);
  // First: the thread that keeps the lifeline inherits it.
  const int host_cpu = registry.header().profile.host_cpu_of_receive_thread[id - 1];
  if (host_cpu >= 0) {
    pin_to_cpu(host_cpu);
  }
  const std::optional<HeldLifeline> lifeline =
    registry.lifelines().try_hold(receive_thread_line + id);
  if (!lifeline) {
    daemon.ready();  // another one was faster
    return;
  }
  registry.use_badge_of(receive_thread_line + id);
  const bool replaces = cluster.header().receive_thread_pid.exchange(getpid()) != 0;
  prctl(PR_SET_NAME, ("manycore_rt_" + std::to_string(id)).c_str());
  prctl(PR_SET_PTRACER, PR_SET_PTRACER_ANY);  // the timekeeper sees by its threads that it waits
  // Before the movers start, which inherit it. The limit may be the priority of the nodes.
  const int priority = registry.header().profile.priority_of_receive_thread[id - 1];
  if (priority > 0 && !run_in_real_time(priority) && !run_in_real_time(priority - 1)) {
    std::fprintf(
      stderr, "[manycore_receive_thread] no right to real-time priority %d: see ulimit -r\n",
      priority);
  }
  TraceIdentity identity;
  identity.cluster = id;
  identity.host_cpu = host_cpu;
  identity.incarnation =
    receive_thread_incarnation(registry.lifelines().holder(receive_thread_line + id));
  identity.label = "receive thread";
  registry.tracer().follow(
    registry.header().trace.receive_threads[id - 1], identity, cluster.header());
  registry.tracer().note(TraceKind::join);
  ReceiveThread receive_thread(registry, id);
  if (replaces) {
    // Dekker with TransferSender: counted before the movers look at what was handed over.
    cluster.header().successors.fetch_add(1, std::memory_order_seq_cst);
    receive_thread.recover();
  }
  movers.start();
  Reaper reaper(registry, id);
  notify_other_reapers(registry, id);  // they watch this process from now on
  daemon.ready();
  receive_thread.run([&](EmcosMessageKind kind, uint32_t process) {
    if (kind == EmcosMessageKind::detach) {
      exit_if_unused(registry);
    }
    reaper.rescan(kind == EmcosMessageKind::attach ? process : nothing);
  });
}

}  // namespace
}  // namespace manycore

int main(int argc, char ** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: manycore_receive_thread PLATFORM CLUSTER\n");
    return 2;
  }
  try {
    manycore::Daemon daemon = manycore::Daemon::detach();
    manycore::serve(argv[1], static_cast<uint32_t>(std::atoi(argv[2])), daemon);
    return 0;
  } catch (const std::exception & error) {
    std::fprintf(stderr, "[manycore_receive_thread] %s\n", error.what());
    return 1;
  }
}
