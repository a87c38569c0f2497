// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/trace_control.hpp"

#include <algorithm>

#include "platform/clock.hpp"
#include "transport/lifecycle/trace_saver.hpp"

namespace manycore {
namespace {

constexpr uint32_t usual_events_log2 = 18;  ///< 8 MiB each, backed as they fill

uint32_t events_log2_of(uint32_t events) {
  if (events == 0) {
    return usual_events_log2;
  }
  uint32_t log2 = min_trace_events_log2;
  while (log2 <= max_trace_events_log2 && (uint64_t{1} << log2) < events) {
    ++log2;
  }
  if (log2 > max_trace_events_log2) {
    throw Error(
      ErrorCode::invalid_argument, "a ring of " + std::to_string(events) +
                                     " events is too large: at most " +
                                     std::to_string(uint64_t{1} << max_trace_events_log2));
  }
  return log2;
}

std::string full_name(const NodeEntry & node) {
  const std::string ns = text_of(node.ns);
  return (ns == "/" ? "" : ns) + "/" + text_of(node.name);
}

uint64_t mask_of(const Registry & registry, const TraceSelection & selection) {
  if (selection.clusters.empty()) {
    return selection.nodes.empty() ? ~uint64_t{0} : 0;
  }
  uint64_t mask = 0;
  for (const uint32_t cluster : selection.clusters) {
    if (cluster == 0 || cluster > registry.header().profile.clusters) {
      throw Error(
        ErrorCode::invalid_argument, "there is no cluster " + std::to_string(cluster) +
                                       ": the platform has clusters 1 to " +
                                       std::to_string(registry.header().profile.clusters));
    }
    mask |= uint64_t{1} << (cluster - 1);
  }
  return mask;
}

void require_stopped(const Registry & registry) {
  const int64_t started_ns = registry.header().trace.started_ns.load();
  if (started_ns != 0) {
    throw Error(
      ErrorCode::invalid_argument,
      "the platform has been traced for " +
        std::to_string((monotonic_ns() - started_ns) / ns_per_s) +
        " s; only one trace can run at a time: stop it ('manycore trace stop') and save it");
  }
}

void require_saved(Registry & registry) {
  const TraceState state = trace_state(registry);
  if (state.pending == 0 && state.lost == 0) {
    return;
  }
  if (registry.header().trace.unsaved_since_ns.load() == 0) {
    // Events that a thread was writing when the last trace was stopped and saved.
    discard_trace(registry);
  } else {
    throw Error(
      ErrorCode::invalid_argument,
      "an earlier trace was not saved (" + std::to_string(state.pending) + " events, " +
        std::to_string(state.lost) +
        " lost): 'manycore trace save -o FILE', or 'manycore trace start --discard'");
  }
}

std::vector<uint32_t> slots_of(Registry & registry, const std::vector<std::string> & names) {
  std::vector<uint32_t> slots;
  for (const std::string & name : names) {
    const size_t before = slots.size();
    for (uint32_t slot = 0; slot < registry.nodes().high_water(); ++slot) {
      if (registry.nodes().is_live(slot) && full_name(registry.nodes()[slot]) == name) {
        slots.push_back(slot);
      }
    }
    if (slots.size() == before) {
      throw Error(
        ErrorCode::invalid_argument,
        "there is no node '" + name + "' on the platform ('manycore node list' shows all)");
    }
  }
  return slots;
}

void set_process(Registry & registry, uint32_t slot, TraceScope scope) noexcept {
  registry.processes()[slot].trace.store(scope, std::memory_order_relaxed);
}

}  // namespace

TraceIdentity identity_of(Registry & registry, uint32_t process) {
  const ProcessEntry & entry = registry.processes()[process];
  TraceIdentity identity;
  identity.cluster = entry.cluster;
  identity.process = process;
  identity.incarnation = entry.slot.incarnation.load();
  identity.core = entry.core;
  identity.host_cpu = entry.host_cpu;
  identity.label = text_of(entry.label);
  return identity;
}

TraceScope scope_of_new_process(const RegistryHeader & header, uint32_t cluster) noexcept {
  const uint64_t clusters = header.trace.clusters.load(std::memory_order_relaxed);
  return header.trace.started_ns.load(std::memory_order_relaxed) != 0 &&
             (clusters >> (cluster - 1) & 1) != 0
           ? TraceScope::all
           : TraceScope::off;
}

void start_trace(Registry & registry, const TraceSelection & selection) {
  require_stopped(registry);
  require_saved(registry);
  const uint32_t events_log2 = events_log2_of(selection.events);
  const Registry::Lock lock(registry);
  require_stopped(registry);  // another trace may have been started since
  const uint64_t clusters = mask_of(registry, selection);
  const std::vector<uint32_t> nodes = slots_of(registry, selection.nodes);
  TraceControl & control = registry.header().trace;
  control.events_log2.store(events_log2);
  control.clusters.store(clusters);
  const int64_t now_ns = monotonic_ns();
  control.unsaved_since_ns.store(now_ns);
  control.started_ns.store(now_ns);
  for (uint32_t cluster = 1; cluster <= max_clusters; ++cluster) {
    const bool chosen = (clusters >> (cluster - 1) & 1) != 0;
    control.receive_threads[cluster - 1].store(chosen ? TraceScope::all : TraceScope::off);
  }
  for (const uint32_t slot : nodes) {
    registry.nodes()[slot].traced.store(1);
    set_process(registry, registry.nodes()[slot].process, TraceScope::some_nodes);
  }
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    if (
      registry.processes().is_live(slot) &&
      scope_of_new_process(registry.header(), registry.processes()[slot].cluster) !=
        TraceScope::off) {
      set_process(registry, slot, TraceScope::all);
    }
  }
}

void stop_trace(Registry & registry) {
  const Registry::Lock lock(registry);
  TraceControl & control = registry.header().trace;
  if (control.started_ns.load() == 0) {
    throw Error(
      ErrorCode::invalid_argument,
      "the platform is not being traced; 'manycore trace start' begins a trace");
  }
  for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
    set_process(registry, slot, TraceScope::off);
  }
  for (uint32_t slot = 0; slot < registry.nodes().high_water(); ++slot) {
    registry.nodes()[slot].traced.store(0);
  }
  for (TraceSwitch & receive_thread : control.receive_threads) {
    receive_thread.store(TraceScope::off);
  }
  control.clusters.store(0);
  control.started_ns.store(0);
}

TraceState trace_state(Registry & registry) {
  const TraceControl & control = registry.header().trace;
  TraceState state;
  state.started_ns = control.started_ns.load();
  state.ring_events = uint64_t{1} << std::min(control.events_log2.load(), max_trace_events_log2);
  state.lost = control.unplaced.load() - control.unplaced_saved.load();
  for (uint32_t id = 1; id <= registry.header().profile.clusters; ++id) {
    if ((control.clusters.load() >> (id - 1) & 1) != 0) {
      state.clusters.push_back(id);
    }
  }
  for (uint32_t slot = 0; slot < registry.nodes().high_water(); ++slot) {
    if (registry.nodes().is_live(slot) && registry.nodes()[slot].traced.load() != 0) {
      state.nodes.push_back(full_name(registry.nodes()[slot]));
    }
  }
  for (const std::string & path : trace_files(registry.paths())) {
    try {
      const TraceReader reader(path, registry.nonce());
      state.pending += reader.pending();
      state.lost += reader.lost();
    } catch (const Error &) {
      // Reported to the process that saves.
    }
  }
  return state;
}

}  // namespace manycore
