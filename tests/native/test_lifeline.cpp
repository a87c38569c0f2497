// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Proof of life: what a held lifeline survives, and what ends it.
#include <doctest/doctest.h>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "child.hpp"
#include "contained_role.hpp"
#include "node_role.hpp"
#include "platform/error.hpp"
#include "platform/lifeline.hpp"
#include "platform/os_process.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint32_t line = 2;

/// A file of four lifelines.
struct File {
  File() { Lifelines::create(path, 4); }
  ~File() {
    unlink(path.c_str());
    rmdir(directory.c_str());
  }

  std::string directory = "/dev/shm/manycore-lifelines-XXXXXX";
  std::string path = std::string(mkdtemp(directory.data())) + "/alive";
};

/// Holds a line until it receives a command.
const Role holder("holder", [](Lines & test, const Arguments & arguments) {
  auto lifeline = Lifelines::open(arguments.at(0)).try_hold(line);
  if (!lifeline) {
    throw std::runtime_error("it is held by another process");
  }
  test.say("holds");
  const std::string order = test.hear();
  if (order == "close all descriptors") {
    for (int fd = STDERR_FILENO; fd < 1024; ++fd) {
      close(fd);
    }
    test.say("closed");
    test.hear();
  } else if (order == "fork") {
    const pid_t child = fork();
    if (child == 0) {
      lifeline.reset();
      test.say("forked");
      pollfd test_ended{STDIN_FILENO, 0, 0};
      poll(&test_ended, 1, -1);
      _exit(0);
    }
    test.hear();
    _exit(0);  // its child continues
  } else if (order == "execute") {
    execl("/bin/sleep", "sleep", "1000", nullptr);
  }
});

}  // namespace

TEST_CASE("a line is held at once, also within one process") {
  const File file;
  const Lifelines here = Lifelines::open(file.path);
  const Lifelines again = Lifelines::open(file.path);
  CHECK_FALSE(again.is_any_held());
  {
    const auto held = here.try_hold(line);
    REQUIRE(held);
    CHECK(again.is_held(line));
    CHECK_FALSE(again.is_held(line + 1));
    CHECK(again.is_any_held());
    CHECK(again.holder(line).pid == getpid());
    CHECK_FALSE(again.try_hold(line));
  }
  CHECK_FALSE(again.is_any_held());
  CHECK(again.try_hold(line));
}

TEST_CASE("a killed process holds nothing; another one may have the line") {
  const File file;
  const Lifelines lifelines = Lifelines::open(file.path);
  for (int i = 0; i < 20; ++i) {
    Child child("holder", {file.path});
    child.expect("holds");
    CHECK(lifelines.is_held(line));
    child.kill();
    CHECK_FALSE(lifelines.is_held(line));
  }
  CHECK(lifelines.try_hold(line));
}

TEST_CASE("a stopped process lives") {
  const File file;
  Child child("holder", {file.path});
  child.expect("holds");
  child.stop();
  CHECK(Lifelines::open(file.path).is_held(line));
}

TEST_CASE("closing every descriptor, as daemons do, ends nothing") {
  const File file;
  Child child("holder", {file.path});
  child.expect("holds");
  child.say("close all descriptors");
  child.expect("closed");
  CHECK(Lifelines::open(file.path).is_held(line));
}

TEST_CASE("a child of fork() holds nothing: the line ends with the parent") {
  const File file;
  const Lifelines lifelines = Lifelines::open(file.path);
  Child child("holder", {file.path});
  child.expect("holds");
  child.say("fork");
  child.expect("forked");
  CHECK(lifelines.is_held(line));  // the child's copy is closed
  child.say("end");
  CHECK(child.wait() == 0);
  CHECK_FALSE(lifelines.is_held(line));
}

TEST_CASE("a holder that executes another program holds nothing") {
  const File file;
  const Lifelines lifelines = Lifelines::open(file.path);
  Child child("holder", {file.path});
  child.expect("holds");
  child.say("execute");
  wait_until("it is another program", [&] { return !lifelines.is_held(line); });
  CHECK(is_running(child.pid()));
}

TEST_CASE("lines are seen across PID namespaces") {
  const File file;
  const Lifelines lifelines = Lifelines::open(file.path);
  Child child("contained", {"holder", file.path});
  const std::string first = child.hear();  // both answer, in any order
  CHECK(first + child.hear() == (first == "holds" ? "holdscontains" : "containsholds"));
  CHECK(lifelines.is_held(line));
  CHECK(lifelines.holder(line).pid == 1);
  CHECK_FALSE(lifelines.holder(line).is_of_this_pid_namespace());
  child.kill();
  wait_until("the other namespace has ended", [&] { return !lifelines.is_held(line); });
  CHECK(lifelines.try_hold(line));
}

TEST_CASE("lines are seen from inside another PID namespace") {
  const File file;
  const auto held = Lifelines::open(file.path).try_hold(line);
  Child child("contained", {"holder", file.path});
  const std::string first = child.hear();
  const std::string second = child.hear();
  CHECK((first + second).find("error: it is held by another process") != std::string::npos);
}

TEST_CASE("a line that the kernel failed to release is released once its holder is found gone") {
  const File file;
  const Lifelines lifelines = Lifelines::open(file.path);
  pid_t thread = 0;
  {
    Child child("holder", {file.path});
    child.expect("holds");
    lifelines.release_if_abandoned(line);
    CHECK(lifelines.is_held(line));  // its holder lives
    thread = child.pid();
    child.kill();
  }
  // As if the kernel had not cleared the thread's number, the first word of the line's mutex.
  const SharedMemory memory = SharedMemory::open(file.path, 8);
  memory.at<pid_t>(sizeof(Lifeline) * (1 + line)) = thread;
  CHECK(lifelines.is_locked(line));
  CHECK_FALSE(lifelines.is_any_held());
  CHECK(lifelines.try_hold(line));
}

TEST_CASE("a file that is not a lifeline file is refused") {
  const File file;
  SUBCASE("empty") { REQUIRE(truncate(file.path.c_str(), 0) == 0); }
  SUBCASE("without its mark") { SharedMemory::open(file.path, 8).at<uint64_t>(0) = 1; }
  SUBCASE("cut off") { REQUIRE(truncate(file.path.c_str(), 128) == 0); }
  const Refusal refusal = refusal_of([&] { Lifelines::open(file.path); });
  CHECK(refusal.code == ErrorCode::corrupt);
  CHECK(refusal.says("manycore clean"));
}
