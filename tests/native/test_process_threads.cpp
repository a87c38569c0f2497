// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// ProcessThreads: what the kernel says of the threads of another process. Does not prove that a
// wake-up between two looks is always seen: virtual_time.pml does.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <linux/userfaultfd.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <functional>
#include <future>
#include <thread>

#include "platform/futex.hpp"
#include "platform/process_threads.hpp"

using namespace manycore;

namespace {

/// A child whose main thread and a second one each do something until they are killed.
class TwoThreads {
public:
  TwoThreads(const std::function<void()> & first, const std::function<void()> & second)
  : pid_(fork()) {
    if (pid_ == 0) {
      std::thread other(second);
      first();
      other.join();
      _exit(0);
    }
  }
  ~TwoThreads() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  TwoThreads(const TwoThreads &) = delete;
  TwoThreads & operator=(const TwoThreads &) = delete;
  pid_t pid() const { return pid_; }

private:
  const pid_t pid_;
};

void wait_for_another() {
  std::promise<void> never;
  never.get_future().wait();
}
void compute() {
  for (volatile int i = 0; true; i = i + 1) {
  }
}
void wait_for_another_process() {
  static FutexWord word{0};
  while (true) {
    futex_wait(word, 0, std::nullopt);
  }
}
/// Reads a file into memory that never comes, as from a disk that does not answer. Needs root.
void read_for_ever() {
  const auto faults = static_cast<int>(syscall(SYS_userfaultfd, O_CLOEXEC));
  uffdio_api api{UFFD_API, 0, 0};
  constexpr size_t size = 4096;
  void * const memory =
    mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  uffdio_register missing{};
  missing.range = {reinterpret_cast<uint64_t>(memory), size};
  missing.mode = UFFDIO_REGISTER_MODE_MISSING;
  if (
    faults < 0 || ioctl(faults, UFFDIO_API, &api) != 0 ||
    ioctl(faults, UFFDIO_REGISTER, &missing) != 0) {
    _exit(EXIT_FAILURE);
  }
  (void)!read(open("/proc/self/exe", O_RDONLY), memory, size);
}
void sleep_long() { usleep(1'000'000'000); }

/// Looks until the threads have come so far.
template<typename Predicate>
ProcessThreads::Look look_until(pid_t pid, Predicate predicate) {
  ProcessThreads threads(pid);
  ProcessThreads::Look look = threads.look({}, {});
  while (!predicate(look)) {
    look = threads.look({}, {});
  }
  return look;
}

}  // namespace

TEST_CASE("threads that wait for each other sleep") {
  const TwoThreads child(wait_for_another, wait_for_another);
  CHECK(look_until(child.pid(), [](const auto & look) { return look.asleep; }).tid == 0);
}

TEST_CASE(
  "a thread that sleeps by the clock is awake, and named, unless it is known to be blocked") {
  const TwoThreads child(wait_for_another, sleep_long);
  const auto sleeps = [](const auto & look) { return look.doing == "sleeps by the wall clock"; };
  const ProcessThreads::Look look = look_until(child.pid(), sleeps);
  CHECK(!look.asleep);
  CHECK(look.tid > child.pid());
  ProcessThreads threads(child.pid());
  CHECK(threads.look({look.tid}, {}).asleep);
}

TEST_CASE("a thread that another process computes for is awake, and named") {
  const TwoThreads child(wait_for_another, wait_for_another_process);
  const auto waits = [](const auto & look) { return !look.doing.empty(); };
  const ProcessThreads::Look look = look_until(child.pid(), waits);
  CHECK(!look.asleep);
  CHECK(look.doing == "waits for a lock, for another process, or with a timeout of the wall clock");
}

TEST_CASE("a thread that waits for a file is awake, and named") {
  if (geteuid() != 0) {
    return;
  }
  const TwoThreads child(wait_for_another, read_for_ever);
  const auto reads = [](const auto & look) { return look.doing == "reads a file"; };
  CHECK(!look_until(child.pid(), reads).asleep);
}

TEST_CASE("a thread that computes is awake, though another one sleeps") {
  const TwoThreads child(compute, wait_for_another);
  ProcessThreads threads(child.pid());
  for (int i = 0; i < 1000; ++i) {
    REQUIRE(!threads.look({}, {}).asleep);
  }
}

TEST_CASE("a thread that takes the place of another one is not taken for it") {
  std::array<int, 2> go{};
  std::array<int, 2> gone{};
  REQUIRE(pipe(go.data()) == 0);
  REQUIRE(pipe(gone.data()) == 0);
  char byte = 0;
  const TwoThreads child(
    [&] {  // as the second one: what it waits for comes when the test has seen it
      std::thread second([&] { (void)!read(go[0], &byte, 1); });
      second.join();
      std::thread third(compute);
      (void)!write(gone[1], &byte, 1);
      third.join();
    },
    wait_for_another);
  ProcessThreads threads(child.pid());
  while (!threads.look({}, {}).asleep) {
  }
  REQUIRE(write(go[1], &byte, 1) == 1);
  REQUIRE(read(gone[0], &byte, 1) == 1);
  for (int i = 0; i < 1000; ++i) {
    REQUIRE(!threads.look({}, {}).asleep);
  }
}

TEST_CASE("a process that has ended is at rest") {
  const pid_t pid = fork();
  if (pid == 0) {
    _exit(0);
  }
  waitpid(pid, nullptr, 0);
  CHECK(ProcessThreads(pid).look({}, {}).asleep);
}
