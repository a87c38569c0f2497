// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// A publisher reserves SMEM for a larger topic DSM under the registry lock, and backs it with
// memory without the lock. Whatever happens to it in between, other processes continue, and the
// SMEM is not lost.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/mount.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <csignal>

#include "child.hpp"
#include "messages.hpp"
#include "platform_of_test.hpp"
#include "private_shm.hpp"
#include "transport/topic_dsm/generation.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint64_t mebibyte = 1 << 20;
constexpr uint64_t large = 256 * mebibyte;

/// Publishes a large message on each command, and answers "ok" or the error.
const Role greedy("greedy", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/large", keep_last(1)));
  test.say("ready");
  while (true) {
    test.hear();
    const Refusal refusal = refusal_of([&] { publish(*publisher, 1, large); });
    test.say(refusal.code ? refusal.text : "ok");
  }
});

/// Reserves SMEM for a generation and then stops. "locked": stops holding the registry lock.
const Role reserver("reserver", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  const auto publisher = process->create_publisher(on_topic("/reserved", keep_last(1)));
  Registry registry(PlatformPaths::of(arguments.at(0)));
  EndpointEntry * entry = &registry.endpoints()[0];
  while (entry->gid != publisher->gid()) {
    ++entry;
  }
  Cluster & cluster = registry.clusters().at(1);
  auto & dsm = *cluster.find<TopicDsmHeader>(entry->block.offset());
  const auto reserve = [&] { Generation::reserve(cluster, dsm.generations[1], mebibyte, 16); };
  if (arguments.at(1) == "locked") {
    const Registry::Lock lock(registry);
    reserve();
    test.say("reserved");
    raise(SIGSTOP);
  }
  {
    const Registry::Lock lock(registry);
    reserve();
  }
  test.say("reserved");
  raise(SIGSTOP);
});

struct Fixture {
  uint64_t used_bytes() { return inspection.used_bytes(); }
  uint64_t resident_bytes() const { return inspection.resident_bytes(); }
  /// A process stopped in the middle of backing a large message.
  Child stopped_while_it_backs() {
    while (true) {
      Child greedy("greedy", {platform.name()});
      greedy.expect("ready");
      const uint64_t before = resident_bytes();
      greedy.say("publish");
      wait_until("some is backed", [&] { return resident_bytes() > before + large / 16; });
      greedy.stop();
      if (resident_bytes() < before + large) {
        return greedy;
      }
    }
  }
  void wait_until_alone() {
    wait_until("the dead are gone", [&] { return inspection.live_processes() == 1; });
    inspection.wait_until_swept();
  }

  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  Inspection inspection{platform};
};

/// Nearly fills a /dev/shm that is made small, during its lifetime.
class FullShm {
public:
  FullShm() {
    remount("size=512m");
    struct statvfs fs {};
    require(statvfs("/dev/shm", &fs) == 0);
    FileDescriptor filler(open(path, O_CREAT | O_RDWR, 0600));
    const uint64_t bytes = uint64_t{fs.f_bavail} * fs.f_frsize - 4 * mebibyte;
    require(posix_fallocate(filler.get(), 0, static_cast<off_t>(bytes)) == 0);
  }
  ~FullShm() {
    unlink(path);
    remount("size=50%");
  }

private:
  static constexpr const char * path = "/dev/shm/filler";
  static void remount(const char * size) {
    require(mount("tmpfs", "/dev/shm", "tmpfs", MS_REMOUNT, size) == 0);
  }
};

}  // namespace

TEST_CASE("a publisher stopped while it backs memory delays no other process") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/other", keep_last(10)));
  const auto subscription = f.process->create_subscription(on_topic("/other", keep_last(10)));
  Child greedy = f.stopped_while_it_backs();
  publish(*publisher, 1, 100'000);  // grows
  CHECK(take_all(*subscription) == numbers(1, 1));
  f.process->create_publisher(on_topic("/another", keep_last(10)));
  greedy.resume();
  greedy.expect("ok");
}

TEST_CASE("a publisher killed while it backs memory: nothing of it is left") {
  Fixture f;
  const uint64_t used = f.used_bytes();
  const uint64_t resident = f.resident_bytes();
  {
    Child greedy = f.stopped_while_it_backs();
    CHECK(f.used_bytes() >= used + large);
  }
  f.wait_until_alone();
  CHECK(f.used_bytes() == used);
  CHECK(f.resident_bytes() < resident + mebibyte);
}

TEST_CASE("a publisher killed between reservation and backing: the reservation is undone") {
  Fixture f;
  const uint64_t used = f.used_bytes();
  for (const std::string when : {"unlocked", "locked"}) {
    CAPTURE(when);
    {
      Child child("reserver", {f.platform.name(), when});
      child.expect("reserved");
      CHECK(f.used_bytes() > used + mebibyte);
      child.wait_until_stopped();
    }
    f.wait_until_alone();
    CHECK(f.used_bytes() == used);
  }
}

TEST_CASE("a message reserves what it needs, and no more") {
  Fixture f;
  const uint64_t used = f.used_bytes();
  const auto publisher = f.process->create_publisher(on_topic("/large", keep_last(1)));
  publish(*publisher, 1, large);
  CHECK(f.used_bytes() > used + large);
  CHECK(f.used_bytes() < used + large + mebibyte);
}

TEST_CASE("/dev/shm is full when a reservation is backed: an error, and the SMEM is free again") {
  if (!has_private_shm()) {
    return;  // never fills the machine's /dev/shm
  }
  Fixture f;
  Child greedy = f.stopped_while_it_backs();
  const uint64_t used = f.used_bytes();
  {
    const FullShm full;
    greedy.resume();
    const std::string refusal = greedy.hear();
    CHECK_MESSAGE(refusal.find("a message of 268435456 bytes on '/large'") == 0, refusal);
    CHECK_MESSAGE(refusal.find("enlarge it") != std::string::npos, refusal);
    CHECK(f.used_bytes() < used - large);
  }
  CHECK(f.resident_bytes() < large / 16);
  greedy.say("publish");
  greedy.expect("ok");
}
