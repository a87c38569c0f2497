// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Tracing: each claim of a record written while traced has its write, earlier than the claim; what
// a ring could not hold is counted; killed processes leave their traces.
#include <doctest/doctest.h>

#include <csignal>
#include <list>
#include <thread>

#include "node_role.hpp"
#include "trace_of_test.hpp"
#include "waiting.hpp"

using namespace manycore;
using namespace trace_of_test;

TEST_CASE("a ring returns each event complete and in order, or counts it as lost") {
  TraceRing ring{};
  static constexpr uint32_t events_log2 = 7;
  std::vector<TraceEvent> events(uint64_t{1} << events_log2);
  constexpr uint64_t count = 400'000;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    TraceRingWriter writing(ring, events.data(), events_log2);
    for (uint64_t i = 1; i <= count; ++i) {
      writing.push({static_cast<int64_t>(i), i, ~i, 7, 8, TraceKind::write}, [](uint64_t) {
        return uint64_t{1} << events_log2;
      });
    }
    done.store(true);
  });
  uint64_t kept = 0;
  uint64_t last = 0;
  bool whole = true;
  for (bool is_last = false; !is_last;) {
    is_last = done.load();
    const uint64_t written = ring.written.load(std::memory_order_acquire);
    uint64_t read = ring.read.load(std::memory_order_relaxed);
    for (; read != written; ++read, ++kept) {
      const TraceEvent event = events[read & (events.size() - 1)];
      whole = whole && event.number > last && event.value == ~event.number &&
              event.time_ns == static_cast<int64_t>(event.number) && event.endpoint == 7;
      last = event.number;
    }
    ring.read.store(read, std::memory_order_release);
  }
  writer.join();
  CHECK(whole);
  CHECK(kept > 0);
  CHECK(kept + ring.lost.load() == count);
}

TEST_CASE("events are lost while there is no memory for them") {
  TraceRing ring{};
  std::vector<TraceEvent> events(128);
  TraceRingWriter writer(ring, events.data(), 7);
  uint64_t room = 0;
  const auto back = [&](uint64_t backed) { return backed + room; };
  writer.push({}, back);
  room = 64;
  for (int i = 0; i < 65; ++i) {
    writer.push({}, back);
  }
  CHECK(ring.lost.load() == 1);
  CHECK(ring.written.load() == 65);
  CHECK(ring.backed == 128);
}

TEST_CASE("without a trace nothing is recorded, and no file exists") {
  Fixture f;
  f.talk(1, 10);
  CHECK(mapped_trace_files(f) == 0);
  start_trace(f.registry(), {});
  stop_trace(f.registry());
  f.talk(11, 20);
  CHECK(mapped_trace_files(f) == 0);
}

TEST_CASE("each claim of a record published while traced has its write, before it") {
  Fixture f;
  f.talk(1, 5);
  start_trace(f.registry(), {});
  f.talk(6, 105);
  stop_trace(f.registry());
  f.talk(106, 110);
  const Saved saved(f.registry());
  CHECK(saved.lost == 0);
  CHECK(saved.claimed_ns.size() == 100);
  CHECK(saved.of_kind.at(TraceKind::publish_begin) == 100);
  CHECK(saved.of_kind.at(TraceKind::publish_end) == 100);
  CHECK(saved.of_kind.at(TraceKind::release) == 100);
  CHECK(saved.hinted_ns.size() == 100);
  CHECK(saved.of_kind.at(TraceKind::cpu) >= 1);
  CHECK(saved.of_kind.at(TraceKind::smem) >= 1);
  saved.check_claims();
  CHECK(Saved(f.registry()).events == 0);
}

TEST_CASE("between clusters the receive thread's events lie between write and claim") {
  Fixture f;
  Node listener(f.platform, 2);
  listener.tell("subscription /x 100");
  f.platform.receive_thread(2);
  wait_until("a match", [&] { return f.publisher->matched().current == 2; });
  f.talk(1, 1);
  listener.tell("take 1 1 1");  // from now on the listener uses hints
  start_trace(f.registry(), {});
  for (uint64_t i = 2; i <= 51; ++i) {
    f.talk(i, i);
    listener.tell("take " + std::to_string(i) + " " + std::to_string(i) + " 1");
  }
  stop_trace(f.registry());
  const Saved saved(f.registry());
  CHECK(saved.files == 3);
  CHECK(saved.lost == 0);
  CHECK(saved.claimed_ns.size() == 100);
  CHECK(saved.of_kind.at(TraceKind::send) == 50);
  CHECK(saved.of_kind.at(TraceKind::receive) == 50);
  CHECK(saved.hinted_ns.size() == 100);
  saved.check_claims();
  for (const auto & [record, hinted_ns] : saved.hinted_ns) {
    CHECK(saved.written_ns.at(record) <= hinted_ns);
  }
}

TEST_CASE("a receive thread wakes readers in the order of their matches") {
  Fixture f;
  std::list<Node> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_front(f.platform, 2);
  }
  std::vector<uint64_t> matched;  // slots of processes: the last one to join is the first
  for (Node & reader : readers) {
    reader.tell("subscription /x 100");
    wait_until("a match", [&] { return f.publisher->matched().current == 2 + matched.size(); });
    matched.push_back(f.inspection.readers_of(*f.publisher).back().process);
  }
  f.platform.receive_thread(2);
  start_trace(f.registry(), {{2}, {}, 0});
  publish(*f.publisher, 1);
  publish(*f.publisher, 2);  // once it is handled, the threads have been woken for the first
  const ClusterHeader & cluster = f.registry().clusters().at(2).header();
  wait_until("all hints", [&] { return cluster.notifications == 6; });
  stop_trace(f.registry());
  TraceSaver saver(f.registry());
  std::vector<uint64_t> woken;
  for (const ProcessTrace & process : saver.processes()) {
    for (const ThreadTrace & thread : process.threads) {
      for (const TraceEvent & event : thread.events) {
        if (!process.process && event.kind == TraceKind::wake && woken.size() < matched.size()) {
          woken.push_back(event.number);
        }
      }
    }
  }
  saver.finish();
  CHECK(woken == matched);
}

TEST_CASE("a process that joins later is traced as well; only the selected cluster and nodes are") {
  Fixture f;
  start_trace(f.registry(), {{2}, {}, 0});
  Node late(f.platform, 2);
  late.tell("publisher /y 10");
  late.tell("publish 1 10 64");
  f.talk(1, 10);
  f.platform.receive_thread(2);
  stop_trace(f.registry());
  const Saved saved(f.registry());
  CHECK(saved.files == 2);
  CHECK(saved.of_kind.at(TraceKind::write) == 10);
  CHECK(saved.of_kind.at(TraceKind::join) == saved.files);

  EndpointSpec spec = on_topic("/of_node", keep_last(10));
  spec.node = f.process->add_node("chosen", "/ns", "/");
  const auto chosen = f.process->create_publisher(spec);
  EndpointSpec other_spec = on_topic("/x", keep_last(10));
  other_spec.node = f.process->add_node("other", "/", "/");
  const auto other = f.process->create_publisher(other_spec);
  start_trace(f.registry(), {{}, {"/ns/chosen"}, 0});
  CHECK(trace_state(f.registry()).nodes == std::vector<std::string>{"/ns/chosen"});
  publish(*chosen, 1);
  publish(*other, 1);
  stop_trace(f.registry());
  CHECK(Saved(f.registry()).of_kind.at(TraceKind::write) == 1);
  CHECK(
    refusal_of([&] { start_trace(f.registry(), {{}, {"/nobody"}, 0}); }).says("no node '/nobody'"));
  CHECK(refusal_of([&] { start_trace(f.registry(), {{9}, {}, 0}); }).says("no cluster 9"));
}

TEST_CASE("a ring reports what it cannot hold: saved and lost events add up to all") {
  Fixture f;
  start_trace(f.registry(), {{}, {}, 128});
  f.talk(1, 200);
  stop_trace(f.registry());
  const Saved small(f.registry());
  start_trace(f.registry(), {});
  f.talk(201, 400);
  stop_trace(f.registry());
  // Rings keep the size with which they were created.
  const Saved again(f.registry());
  CHECK(small.lost > 0);
  CHECK(small.events > 0);
  CHECK(small.of_sites() == again.of_sites());
}

TEST_CASE("an ended thread's ring is reused by another thread once it is saved") {
  Fixture f;
  start_trace(f.registry(), {});
  for (int round = 0; round < 3; ++round) {
    for (uint32_t i = 0; i < trace_rings_per_process; ++i) {
      std::thread([&] { publish(*f.publisher, 1); }).join();
    }
    const Saved saved(f.registry());
    CHECK(saved.of_kind.at(TraceKind::write) == trace_rings_per_process);
    CHECK(saved.lost == 0);
  }
  for (uint32_t i = 0; i < trace_rings_per_process + 1; ++i) {
    std::thread([&] { publish(*f.publisher, 1); }).join();
  }
  const Saved full(f.registry());
  CHECK(full.of_kind.at(TraceKind::write) == trace_rings_per_process);
  CHECK(full.lost > 0);
}

TEST_CASE("a killed publisher's events stay until they are saved, then its file is removed") {
  Fixture f(keep_all());  // bounds its lead, so that its ring does not fill up
  start_trace(f.registry(), {});
  for (int round = 0; round < 5; ++round) {
    Node talker(f.platform, 1);
    talker.tell("publisher /x keep_all");
    talker.say("publish_endlessly 64");
    for (int i = 0; i < 200; ++i) {
      take_next(*f.process, *f.subscription);
    }
    talker.kill();
    wait_until("it is reaped", [&] { return f.inspection.live_processes() == 1; });
    take_all(*f.subscription);
    const size_t before = mapped_trace_files(f);
    const Saved saved(f.registry());
    saved.check_claims();
    CHECK(saved.claimed_ns.size() >= 200);
    CHECK(mapped_trace_files(f) == before - 1);
  }
}

TEST_CASE("a killed receive thread leaves its events, and its successor is traced") {
  Fixture f;
  Node listener(f.platform, 2);
  listener.tell("subscription /x 1000");
  const pid_t first = f.platform.receive_thread(2);
  wait_until("a match", [&] { return f.publisher->matched().current == 2; });
  start_trace(f.registry(), {});
  f.talk(1, 50);
  listener.tell("take 1 50 1");
  kill(first, SIGKILL);
  f.talk(51, 100);
  f.platform.receive_thread(2, first);
  f.talk(101, 150);
  listener.tell("take 51 150 1");
  const Saved saved(f.registry());
  saved.check_claims();
  CHECK(saved.claimed_ns.size() == 300);
  CHECK(saved.files >= 4);
}

TEST_CASE("switched on and off while it is written, a trace loses no claim's write") {
  Fixture f;
  std::atomic<bool> done{false};
  std::thread switching([&] {
    while (!done.load()) {
      start_trace(f.registry(), {{}, {}, 1 << 20});
      stop_trace(f.registry());
      discard_trace(f.registry());
    }
  });
  f.talk(1, 2000);
  done.store(true);
  switching.join();
  start_trace(f.registry(), {});
  f.talk(2001, 2100);
  stop_trace(f.registry());
  const Saved saved(f.registry());
  CHECK(saved.claimed_ns.size() == 100);
  saved.check_claims();
}
