// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The registry lock where pthread's robust mutexes are not enough: PID namespaces in which threads
// have equal numbers, owners that are frozen, and many processes at once.
// docs/model/registry_lock.pml covers each order of steps.
#include <doctest/doctest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <sstream>
#include <string>

#include "child.hpp"
#include "contained_role.hpp"
#include "messages.hpp"
#include "node_role.hpp"
#include "platform/lock_owner.hpp"
#include "platform_of_test.hpp"
#include "transport/registry/smem_charge.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

/// A member of a platform that takes the registry lock with its own badge.
struct Member {
  explicit Member(const std::string & platform)
  : process(join_platform(platform)), registry(PlatformPaths::of(platform)) {
    registry.use_badge_of(process_of(registry, ProcessIdentity::own()));
  }

  std::shared_ptr<Process> process;
  Registry registry;
};

/// Takes the lock on command, and holds it until the next one.
const Role owner("owner", [](Lines & test, const Arguments & arguments) {
  Member member(arguments.at(0));
  test.say("thread " + std::to_string(gettid()));
  test.expect("lock");
  const Registry::Lock lock(member.registry);
  test.say("locked");
  test.expect("unlock");
});

struct Fixture {
  TestPlatform platform;
  std::shared_ptr<Process> process = platform.join();
  pid_t receive_thread = platform.receive_thread(1);
  Inspection inspection{platform};
  Registry & registry = inspection.registry();

  bool is_lockable() {
    return !refusal_of([&] {
              const Registry::Lock lock(registry, Registry::Lock::no_wait_ns);
            }).code;
  }
};

/// Starts the role in a PID namespace of its own; returns once it has joined.
Child contained_owner(const Fixture & f) {
  Child child("contained", {"owner", f.platform.name()});
  const std::string first = child.hear();  // both say something, in any order
  const std::string second = child.hear();
  CHECK_MESSAGE((first == "thread 1" || second == "thread 1"), first << ", " << second);
  return child;
}

}  // namespace

TEST_CASE("killed while it waits: an owner of the same thread number elsewhere keeps the lock") {
  Fixture f;
  for (int i = 0; i < 20; ++i) {
    Child owns = contained_owner(f);
    Child waits = contained_owner(f);
    const Standstill no_other(f.platform, 1);
    owns.say("lock");
    owns.expect("locked");
    waits.say("lock");
    wait_until("it waits for the lock", [&] { return f.registry.header().mutex.is_waited_for(); });
    waits.kill();
    CHECK_FALSE(f.is_lockable());
    owns.say("unlock");
    CHECK(owns.wait() == 0);
    { const Registry::Lock lock(f.registry); }
    CHECK(f.registry.header().needs_repair == 0);
  }
}

TEST_CASE("killed while it owns the lock in another PID namespace: the next owner repairs") {
  Fixture f;
  const auto publisher = f.process->create_publisher(on_topic("/x", keep_last(1)));
  std::atomic<uint32_t> & bucket =
    f.registry.header().topic_buckets[hash_name("/x") % topic_bucket_count].first;
  for (int i = 0; i < 20; ++i) {
    Child owns = contained_owner(f);
    const Standstill no_other(f.platform, 1);
    owns.say("lock");
    owns.expect("locked");
    bucket = nothing;  // as a change may leave it
    owns.kill();
    { const Registry::Lock repairs(f.registry); }
    CHECK(bucket != nothing);
  }
}

namespace {

/// A cgroup of this test, removed with it. Empty path where none can be made.
class Cgroup {
public:
  Cgroup(const std::string & parent, const std::string & freeze_file, const std::string & frozen)
  : path_(parent + "/manycore-test-" + std::to_string(getpid())),
    freeze_file_(freeze_file),
    frozen_(frozen) {
    if (mkdir(path_.c_str(), 0700) != 0) {
      path_.clear();
    }
  }
  ~Cgroup() { rmdir(path_.c_str()); }
  Cgroup(const Cgroup &) = delete;
  Cgroup & operator=(const Cgroup &) = delete;

  explicit operator bool() const { return !path_.empty(); }
  void add(pid_t pid) const { write("cgroup.procs", std::to_string(pid)); }
  void freeze() const { write(freeze_file_, frozen_); }
  void thaw() const { write(freeze_file_, frozen_ == "1" ? "0" : "THAWED"); }

private:
  void write(const std::string & file, const std::string & text) const {
    std::ofstream(path_ + "/" + file) << text;
  }
  std::string path_;
  const std::string freeze_file_;
  const std::string frozen_;
};

/// Where the machine's hierarchy of a type is mounted; empty if it is not.
std::string mount_of(const std::string & type, const std::string & option) {
  std::ifstream mounts("/proc/self/mounts");
  std::string device, path, kind, options;
  for (std::string line; std::getline(mounts, line);) {
    std::istringstream(line) >> device >> path >> kind >> options;
    if (kind == type && options.find(option) != std::string::npos) {
      return path;
    }
  }
  return {};
}

void check_frozen_owner(const Cgroup & cgroup) {
  Fixture f;
  const Standstill no_other(f.platform, 1);
  Child owns("owner", {f.platform.name()});
  owns.hear();
  owns.say("lock");
  owns.expect("locked");
  const LockOwner owner{owns.pid(), own_pid_namespace()};
  cgroup.add(owns.pid());
  cgroup.freeze();
  LockOwnerWatch watch;
  wait_until("it is seen to be frozen", [&] { return !watch.may_unlock(owner); });
  const Refusal refusal =
    refusal_of([&] { const Registry::Lock lock(f.registry, Registry::Lock::WhileOwnersRun{}); });
  CHECK_MESSAGE(refusal.says("its cgroup is frozen"), refusal.text);
  cgroup.thaw();
  owns.say("unlock");
  CHECK(owns.wait() == 0);
}

}  // namespace

TEST_CASE("an owner that its cgroup has frozen is not taken for one that runs") {
  const Cgroup unified(mount_of("cgroup2", ""), "cgroup.freeze", "1");
  const Cgroup freezer(mount_of("cgroup", "freezer"), "freezer.state", "FROZEN");
  if (!unified && !freezer) {
    MESSAGE("skipped: no cgroup can be made here");
  }
  for (const Cgroup * const cgroup : {&unified, &freezer}) {
    if (*cgroup) {
      check_frozen_owner(*cgroup);
    }
  }
}

TEST_CASE("an owner that runs may unlock, however often it is looked at") {
  LockOwnerWatch watch;
  const LockOwner self{gettid(), own_pid_namespace()};
  for (int i = 0; i < 3; ++i) {
    CHECK(watch.may_unlock(self));
  }
  CHECK(watch.may_unlock({}));
  CHECK_FALSE(watch.may_unlock({gettid(), own_pid_namespace() + 1}));
}
