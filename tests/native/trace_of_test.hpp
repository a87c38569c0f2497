// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <doctest/doctest.h>

#include <map>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/trace_control.hpp"
#include "transport/lifecycle/trace_saver.hpp"
#include "waiting.hpp"

namespace trace_of_test {

using namespace manycore;

/// Publisher and number of a record.
using Record = std::pair<uint64_t, uint64_t>;

/// A saved trace, by what the tests ask about it.
struct Saved {
  explicit Saved(Registry & registry) {
    TraceSaver saver(registry);
    lost = saver.unplaced();
    for (const ProcessTrace & process : saver.processes()) {
      lost += process.unplaced;
      files += 1;
      for (const ThreadTrace & thread : process.threads) {
        lost += thread.lost;
        add(thread);
      }
    }
    saver.finish();
  }

  void add(const ThreadTrace & thread) {
    int64_t before_ns = 0;
    for (const TraceEvent & event : thread.events) {
      is_ordered = is_ordered && event.time_ns >= before_ns;
      before_ns = event.time_ns;
      ++of_kind[event.kind];
      const Record of_value{event.value & 0xffff'ffff'ffff, event.number};
      const Record own{trace_endpoint(event.endpoint, event.incarnation), event.number};
      if (event.kind == TraceKind::write) {
        ++writes[own];
        written_ns[own] = event.time_ns;
      } else if (event.kind == TraceKind::claim) {
        claimed_ns.emplace(of_value, event.time_ns);
      } else if (event.kind == TraceKind::hint) {
        hinted_ns.emplace(of_value, event.time_ns);
      }
    }
    events += thread.events.size();
  }

  /// Checks that each claim has exactly one write, before it.
  void check_claims() const {
    CHECK(is_ordered);
    for (const auto & [record, time_ns] : claimed_ns) {
      const auto write = written_ns.find(record);
      REQUIRE(write != written_ns.end());
      CHECK(writes.at(record) == 1);
      CHECK(write->second <= time_ns);
    }
  }

  /// Events of the test's own operations, kept or lost, without periodic samples.
  uint64_t of_sites() const {
    uint64_t count = events + lost;
    for (const TraceKind kind : {TraceKind::cpu, TraceKind::smem}) {
      count -= of_kind.count(kind) != 0 ? of_kind.at(kind) : 0;
    }
    return count;
  }

  std::map<TraceKind, uint64_t> of_kind;
  std::map<Record, int> writes;
  std::map<Record, int64_t> written_ns;
  std::multimap<Record, int64_t> claimed_ns;
  std::multimap<Record, int64_t> hinted_ns;
  uint64_t events = 0;
  uint64_t lost = 0;
  size_t files = 0;
  bool is_ordered = true;
};

/// A publisher and a subscription in this process.
struct Fixture {
  explicit Fixture(const Qos & qos = keep_last(100)) {
    // Otherwise the receive thread would join later, and be traced occasionally.
    wait_until(
      "a receive thread that is at work", [&] { return has_pidfds(platform.receive_thread(1)); });
    publisher = process->create_publisher(on_topic("/x", qos));
    subscription = process->create_subscription(on_topic("/x", qos));
  }
  Registry & registry() { return inspection.registry(); }
  void talk(uint64_t first, uint64_t last) {
    for (uint64_t i = first; i <= last; ++i) {
      publish(*publisher, i);
      REQUIRE(take_next(*process, *subscription).number == i);
    }
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join(1);
  std::unique_ptr<Publisher> publisher;
  std::unique_ptr<Subscription> subscription;
  Inspection inspection{platform};
};

inline size_t mapped_trace_files(const Fixture & f) {
  return trace_files(f.platform.paths()).size();
}

}  // namespace trace_of_test
