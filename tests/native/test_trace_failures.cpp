// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Traces that are refused, damaged, or find no room.
#include <doctest/doctest.h>

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <thread>

#include "node_role.hpp"
#include "stepped_child.hpp"
#include "trace_of_test.hpp"
#include "waiting.hpp"

using namespace manycore;
using namespace trace_of_test;

TEST_CASE("one trace at a time, one saver at a time, and no trace is discarded implicitly") {
  Fixture f;
  CHECK(refusal_of([&] { stop_trace(f.registry()); }).says("not being traced"));
  start_trace(f.registry(), {});
  CHECK(
    refusal_of([&] { start_trace(f.registry(), {}); }).says("only one trace can run at a time"));
  f.talk(1, 3);
  stop_trace(f.registry());
  CHECK(refusal_of([&] { start_trace(f.registry(), {}); }).says("was not saved"));
  {
    TraceSaver first(f.registry());
    CHECK(refusal_of([&] { TraceSaver(f.registry()); }).says("is saving the trace"));
  }
  discard_trace(f.registry());
  start_trace(f.registry(), {});
  CHECK(refusal_of([&] {
          stop_trace(f.registry());
          start_trace(f.registry(), {{}, {}, UINT32_MAX});
        }).says("too large"));
}

TEST_CASE("an event recorded after a stopped trace was saved does not block the next trace") {
  Fixture f;
  start_trace(f.registry(), {});
  f.talk(1, 3);
  stop_trace(f.registry());
  CHECK(Saved(f.registry()).events > 0);
  const SharedMemory memory =
    SharedMemory::open(trace_files(f.platform.paths()).at(0), sizeof(TraceFileHeader));
  // As by a thread that was passing a site when the trace was stopped.
  memory.at<TraceFileHeader>(0).rings[0].written.fetch_add(1);
  CHECK(trace_state(f.registry()).pending == 1);
  CHECK_NOTHROW(start_trace(f.registry(), {}));
  CHECK(trace_state(f.registry()).pending == 0);
}

TEST_CASE("a damaged trace file is refused by name, and affects no other process") {
  Fixture f;
  start_trace(f.registry(), {{}, {}, 128});
  f.talk(1, 3);
  const std::string path = trace_files(f.platform.paths()).at(0);
  {
    SharedMemory memory = SharedMemory::open(path, sizeof(TraceFileHeader));
    auto & header = memory.at<TraceFileHeader>(0);
    const auto refused = [&](const std::string & why) {
      const Refusal refusal = refusal_of([&] { TraceSaver(f.registry()); });
      CHECK_MESSAGE(refusal.says(why), refusal.text);
      CHECK(refusal.says(path));
      CHECK_NOTHROW(trace_state(f.registry()));
    };
    const uint64_t read = header.rings[0].read.load();
    header.rings[0].read.store(read - 1000);
    refused("positions");
    header.rings[0].read.store(read);
    const uint64_t offset = header.rings[0].offset;
    header.rings[0].offset = UINT64_MAX - 5;
    refused("positions");
    header.rings[0].offset = offset;
    header.events_log2 = 60;
    refused("does not match its header");
    header.events_log2 = 7;
    ++header.segment.platform_nonce;
    refused("another platform");
    --header.segment.platform_nonce;
    header.segment.version = 10;
    refused("layout version");
    header.segment.version = layout_version;
    header.rings[0].read.store(UINT64_MAX / 2);
    f.talk(4, 8);  // the writer loses its events, nothing else
    header.rings[0].read.store(read);
    CHECK_NOTHROW(TraceSaver(f.registry()));
  }
  CHECK(rename(path.c_str(), (path + ".old").c_str()) == 0);
  CHECK(symlink("/dev/zero", path.c_str()) == 0);
  CHECK(refusal_of([&] { TraceSaver(f.registry()); }).says(path));
}

TEST_CASE("a process without descriptors loses its events, and counts them") {
  Fixture f;
  {
    wait_until("its receive thread is watched", [] { return has_pidfds(getpid()); });
    start_trace(f.registry(), {});
    const NoDescriptors none;
    f.talk(1, 3);
  }
  stop_trace(f.registry());
  const TraceState state = trace_state(f.registry());
  CHECK(state.lost > 0);
  const Saved saved(f.registry());
  CHECK(saved.lost == state.lost);
}

namespace {

const Role starts_trace("starts_trace", [](Lines &, const Arguments & arguments) {
  Registry registry(PlatformPaths::of(arguments.at(0)));
  begin_steps();
  start_trace(registry, {});
  finish_steps();
});

}  // namespace

TEST_CASE("a trace that is being started while another process saves still counts as unsaved") {
  Fixture f;
  const TraceControl & control = f.registry().header().trace;
  SteppedChild starter("starts_trace", {f.platform.name()});
  while (control.unsaved_since_ns.load() == 0) {
    starter.step(1);
    REQUIRE_FALSE(starter.finished());
  }
  REQUIRE(control.started_ns.load() == 0);
  std::atomic<bool> saved{false};
  std::thread saver([&] {
    discard_trace(f.registry());
    saved = true;
  });
  wait_until("the saver is done, or waits for the registry lock", [&] {
    return saved || f.registry().header().mutex.is_waited_for();
  });
  while (!starter.finished()) {
    starter.step(1'000'000);
  }
  saver.join();
  CHECK(control.started_ns.load() != 0);
  CHECK(control.unsaved_since_ns.load() != 0);
}
