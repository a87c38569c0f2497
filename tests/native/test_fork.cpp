// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A child of fork() cannot use what it inherits, and does not harm it.
#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <iostream>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/trace_control.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

struct Fixture {
  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join(1);
  std::unique_ptr<Publisher> publisher = process->create_publisher(on_topic("/x", keep_last(10)));
  std::unique_ptr<Subscription> subscription =
    process->create_subscription(on_topic("/x", keep_last(10)));
};

/// Forks, and returns the result of `act` in the child, in which nothing else of the test runs.
bool in_child(const std::function<bool()> & act) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(timeout_s);  // ends a hang
    bool succeeded = false;
    try {
      succeeded = act();
    } catch (const std::exception & error) {
      std::cerr << "in the child: " << error.what() << std::endl;
    }
    _exit(succeeded ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

bool is_refused(const std::function<void()> & act) {
  return refusal_of(act).says("cannot be used after fork()");
}

}  // namespace

TEST_CASE("in a child of fork() everything inherited fails, with an error that says what to do") {
  Fixture f;
  publish(*f.publisher, 1);
  CHECK(in_child([&] { return is_refused([&] { publish(*f.publisher, 2); }); }));
  CHECK(in_child([&] { return is_refused([&] { f.subscription->claim(); }); }));
  CHECK(in_child([&] { return is_refused([&] { f.process->add_node("n", "/", ""); }); }));
  CHECK(in_child([&] {
    return is_refused([&] { f.process->create_publisher(on_topic("/y", keep_last(1))); });
  }));
  CHECK(in_child([&] {
    return is_refused([&] { f.process->create_subscription(on_topic("/y", keep_last(1))); });
  }));
  CHECK(in_child([&] { return is_refused([&] { f.process->require_membership(); }); }));
  CHECK(in_child([&] { return is_refused([&] { f.publisher->assert_liveliness(); }); }));
  CHECK(take_next(*f.process, *f.subscription).number == 1);
  CHECK_FALSE(take(*f.subscription));
}

TEST_CASE("objects that a child of fork() destroys stay valid in its parent") {
  Fixture f;
  const uint32_t node = f.process->add_node("parent", "/", "");
  const Configurator configurator(f.platform.name() + "-2", host_profile(), {});
  CHECK(in_child([&] {
    f.publisher.reset();
    f.subscription.reset();
    f.process->remove_node(node);
    f.process.reset();
    configurator.~Configurator();
    return true;
  }));
  CHECK(f.process->graph().nodes().size() == 1);
  CHECK(f.process->graph().endpoints().size() == 2);
  for (uint64_t number = 1; number <= 100; ++number) {
    publish(*f.publisher, number);
    CHECK(take_next(*f.process, *f.subscription).number == number);
  }
  CHECK(is_alive(PlatformPaths::of(f.platform.name() + "-2")));
}

TEST_CASE("a claim and a draft that are open at a fork stay open in the parent") {
  Fixture f;
  publish(*f.publisher, 1);
  auto claim = f.subscription->claim();
  REQUIRE(claim);
  auto draft = std::make_optional(f.publisher->draft(sizeof(Payload)));
  CHECK(in_child([&] {
    claim.reset();
    draft.reset();
    return true;
  }));
  Payload{1, 2, sizeof(Payload)}.write(draft->data());
  f.publisher->publish(std::move(*draft), sizeof(Payload), 1, {});
  claim.reset();
  CHECK(take_next(*f.process, *f.subscription).number == 2);
}

TEST_CASE("a member that was removed as dead notices before it touches memory") {
  Fixture f;
  Inspection inspection(f.platform);
  Registry & registry = inspection.registry();
  const uint32_t slot = inspection.slot_of(f.publisher->gid());
  // As if it was reaped and the slot taken.
  registry.endpoints()[slot].slot.incarnation.fetch_add(1);
  const Refusal refusal = refusal_of([&] { publish(*f.publisher, 1); });
  CHECK(refusal.code == ErrorCode::system);
  CHECK(refusal.says("removed as dead"));
  f.publisher.reset();  // leaves the slot to its new owner
  CHECK(registry.endpoints().is_live(slot));
  registry.endpoints()[slot].slot.incarnation.fetch_sub(1);
}

TEST_CASE("a child of fork() writes nothing into its parent's trace") {
  Fixture f;
  Registry registry(f.platform.paths());
  f.platform.receive_thread(1);  // wait for it: it could otherwise trace its start later
  start_trace(registry, {});
  publish(*f.publisher, 1);
  const uint64_t before = trace_state(registry).pending;
  CHECK(in_child([&] {
    f.process->tracer().note(TraceKind::join);
    f.process.reset();
    return true;
  }));
  CHECK(trace_state(registry).pending == before);
  stop_trace(registry);
}
