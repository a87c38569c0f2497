// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Programs that become daemons close all descriptors, including those of the platform, and the
// numbers are then reused for other files.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "child.hpp"
#include "messages.hpp"
#include "platform_of_test.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr size_t large_bytes = 1'000'000;  // requires the topic DSM to grow
constexpr const char * content = "untouched";

/// Closes all descriptors except those to the test, and opens a file under their numbers.
void take_over_descriptors(const std::string & file) {
  for (int fd = 3; fd < 256; ++fd) {
    close(fd);
  }
  for (int fd = 3; fd < 64; ++fd) {
    require(open(file.c_str(), O_RDWR | O_APPEND | O_CLOEXEC) == fd);
  }
}

void require_taken_over(const std::string & file) {
  struct stat expected {};
  require(stat(file.c_str(), &expected) == 0);
  for (int fd = 3; fd < 64; ++fd) {
    struct stat found {};
    require(fstat(fd, &found) == 0 && found.st_ino == expected.st_ino);
  }
}

const Role daemon_publisher("daemon", [](Lines & test, const Arguments & arguments) {
  auto process = join_platform(arguments.at(0));
  auto publisher = process->create_publisher(on_topic("/x", keep_last(10)));
  wait_until("a match", [&] { return publisher->matched().current == 1; });
  wait_until("its receive thread is watched", [] { return has_pidfds(getpid()); });
  take_over_descriptors(arguments.at(1));
  publish(*publisher, 1);
  publish(*publisher, 2, large_bytes);
  test.say("published");
  test.expect("close");
  publisher.reset();
  process.reset();
  require_taken_over(arguments.at(1));
  test.say("closed");
  test.hear();
});

}  // namespace

TEST_CASE("a process whose descriptors were closed continues, and uses no other file by mistake") {
  const TestPlatform platform;
  const auto process = platform.join(2);
  const auto subscription = process->create_subscription(on_topic("/x", keep_last(10)));
  char file[] = "/tmp/manycore-test-XXXXXX";
  close(mkstemp(file));
  std::ofstream(file) << content;
  {
    Child daemon("daemon", {platform.name(), file});
    daemon.expect("published");
    CHECK(take_next(*process, *subscription).number == 1);
    CHECK(take_next(*process, *subscription).number == 2);
    daemon.say("close");
    daemon.expect("closed");
  }
  CHECK(std::filesystem::file_size(file) == std::string(content).size());
  std::filesystem::remove(file);
}
