// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/lifecycle/trace_saver.hpp"

#include <dirent.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace manycore {
namespace {

/// Saving a million events takes seconds, so another saver is not waited for.
constexpr int lock_timeout_ms = 100;

/// Start of the last trace if it is stopped and not saved, else 0. Reads both words under the
/// registry lock, under which start_trace() and stop_trace() change them together.
int64_t stopped_trace_ns(Registry & registry) {
  const Registry::Lock lock(registry);
  const TraceControl & control = registry.header().trace;
  return control.started_ns.load() == 0 ? control.unsaved_since_ns.load() : 0;
}

template<typename Visit>
void visit_names(const std::string & path, Visit visit) {
  DIR * const directory = opendir(path.c_str());
  if (directory == nullptr) {
    return;
  }
  while (const dirent * const entry = readdir(directory)) {
    visit(entry->d_name);
  }
  closedir(directory);
}

}  // namespace

std::vector<std::string> trace_files(const PlatformPaths & paths) {
  std::vector<std::string> found;
  constexpr const char * prefix = "trace-";
  visit_names(paths.directory, [&](const char * name) {
    if (std::strncmp(name, prefix, std::strlen(prefix)) == 0) {
      found.push_back(paths.directory + "/" + name);
    }
  });
  std::sort(found.begin(), found.end());
  return found;
}

void remove_unfinished_traces(const Registry & registry) {
  const std::string & directory = registry.paths().directory;
  visit_names(directory, [&](const char * name) {
    const std::optional<UnfinishedTrace> trace = UnfinishedTrace::of(name);
    if (!trace) {
      return;
    }
    const ProcessIdentity holder = registry.lifelines().holder(trace->line);
    const bool is_writer = holder.pid == trace->pid && holder.start_time == trace->start_time;
    if (!is_writer || !registry.lifelines().is_held(trace->line)) {
      unlink((directory + "/" + name).c_str());
    }
  });
}

TraceSaver::TraceSaver(Registry & registry) : registry_(registry) {
  const std::string lock = registry.paths().directory + "/.trace-lock";
  try {
    lock_ = FileLock::acquire(lock, lock_timeout_ms);
  } catch (const Error & error) {
    if (error.code() != ErrorCode::timeout) {
      throw;
    }
    throw Error(
      ErrorCode::timeout,
      "another process is saving the trace of this platform; retry when it is done");
  }
  const TraceControl & control = registry.header().trace;
  // Read before the events: if the trace is stopped here, the events below are complete, except for
  // those that threads are writing at this moment.
  stopped_trace_ns_ = stopped_trace_ns(registry);
  unplaced_total_ = control.unplaced.load();
  unplaced_ = unplaced_total_ - control.unplaced_saved.load();
  for (const std::string & path : trace_files(registry.paths())) {
    TraceReader reader(path, registry.nonce());
    const TraceFileHeader & header = static_cast<const TraceReader &>(reader).header();
    ProcessTrace process;
    process.cluster = header.segment.cluster;
    if (header.process != nothing) {
      process.process = header.process;
    }
    process.pid = header.pid;
    process.core = header.core;
    process.host_cpu = header.host_cpu;
    process.label = text_of(header.label);
    // Read before the events: if the writer is dead, they are complete.
    process.alive = is_writer_alive(header);
    process.threads = reader.read();
    process.names = reader.names();
    process.unplaced = reader.unplaced();
    processes_.push_back(std::move(process));
    readers_.push_back(std::move(reader));
  }
}

bool TraceSaver::is_writer_alive(const TraceFileHeader & header) const {
  const Lifelines & alive = registry_.lifelines();
  if (header.process == nothing) {
    const uint32_t line = receive_thread_line + header.segment.cluster;
    return line < configurator_line && alive.is_held(line) &&
           alive.holder(line).pid == header.pid &&
           receive_thread_incarnation(alive.holder(line)) == header.incarnation;
  }
  return registry_.processes().is_live(header.process) &&
         registry_.processes()[header.process].slot.incarnation.load() == header.incarnation &&
         alive.is_held(header.process);
}

/// If a process had ended before its file was read, the file is complete and can be removed.
void TraceSaver::finish() noexcept {
  TraceControl & control = registry_.header().trace;
  control.unplaced_saved.store(unplaced_total_);
  if (stopped_trace_ns_ != 0) {  // unless another trace was started since
    control.unsaved_since_ns.compare_exchange_strong(stopped_trace_ns_, 0);
  }
  for (size_t i = 0; i < readers_.size(); ++i) {
    readers_[i].free_read();
    if (!processes_[i].alive && readers_[i].is_drained()) {
      unlink(readers_[i].path().c_str());
    }
  }
}

void discard_trace(Registry & registry) { TraceSaver(registry).finish(); }

}  // namespace manycore
