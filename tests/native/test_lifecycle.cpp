// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Platforms are created on demand and removed completely.
#include <doctest/doctest.h>

#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <string>
#include <system_error>

#include "messages.hpp"
#include "node_role.hpp"
#include "private_shm.hpp"
#include "transport/lifecycle/cleaning.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

mode_t permissions_of(const std::string & path) {
  struct stat status {};
  return stat(path.c_str(), &status) == 0 ? status.st_mode & 0777 : 0;
}

size_t open_descriptors() {
  const std::filesystem::directory_iterator all("/proc/self/fd");
  return static_cast<size_t>(std::distance(begin(all), end(all)));
}

bool has_thread(const std::string & name) {
  for (const auto & thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(thread.path() / "comm");
    std::string found;
    if (std::getline(file, found) && found == name) {
      return true;
    }
  }
  return false;
}

void write_file(const std::string & path, const std::string & content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// Kills all processes of a platform whose nodes are in clusters 1, 2 ..: nodes first or receive
/// threads first.
void kill_whole(const TestPlatform & platform, std::vector<Node> & nodes, bool nodes_first) {
  std::vector<pid_t> receive_threads;
  for (uint32_t cluster = 1; cluster <= nodes.size(); ++cluster) {
    receive_threads.push_back(platform.receive_thread(cluster));
  }
  for (Node & node : nodes) {
    node.stop();  // so that it does not react to the other deaths
  }
  for (const pid_t pid : receive_threads) {
    stop_process(pid);
  }
  if (nodes_first) {
    nodes.clear();
  }
  for (const pid_t pid : receive_threads) {
    kill(pid, SIGKILL);
  }
  nodes.clear();
  for (const pid_t pid : receive_threads) {
    wait_until("all is killed", [&] { return !is_running(pid); });
  }
}

}  // namespace

TEST_CASE("a join creates what is missing, private to this user; a leave removes it") {
  TestPlatform platform;
  CHECK_FALSE(platform.exists());
  {
    const auto process = platform.join(2);
    platform.receive_thread(2);
    CHECK(permissions_of(platform.paths().user_directory) == 0700);
    CHECK(permissions_of(platform.paths().directory) == 0700);
    for (const std::string & file :
         {platform.paths().registry(), platform.paths().alive(), platform.paths().cluster(2),
          platform.paths().pipe(2)}) {
      CAPTURE(file);
      CHECK(permissions_of(file) == 0600);
    }
    CHECK(permissions_of(platform.paths().cluster(1)) == 0);  // no node has joined it
    CHECK(process->graph().processes().size() == 1);
    CHECK(process->graph().clusters().size() == 1);
  }
  CHECK_FALSE(platform.exists());
}

TEST_CASE("a second join of the same process is the same membership") {
  TestPlatform platform;
  const auto process = platform.join(1);
  CHECK(platform.join(1) == process);
  CHECK(process->graph().processes().size() == 1);
}

TEST_CASE("the platform stays until the last process leaves") {
  TestPlatform platform;
  auto here = platform.join(1);
  Node there(platform, 2);
  CHECK(here->graph().processes().size() == 2);
  here.reset();
  CHECK(platform.exists());
  there.tell("publisher /x 1");
  there.say("leave");
  CHECK(there.wait() == 0);
  CHECK_FALSE(platform.exists());
}

TEST_CASE("nodes that are all killed leave nothing: the receive threads clean up") {
  TestPlatform platform;
  std::vector<Node> nodes;
  for (const uint32_t cluster : {1u, 1u, 2u}) {
    nodes.emplace_back(platform, cluster);
    nodes.back().tell("publisher /x 1");
    platform.receive_thread(
      cluster);  // the files of a process killed before it exists are left to the next start
  }
  nodes.clear();  // ~TestPlatform waits for this
}

TEST_CASE("killed whole, then started again: works, and the leftovers are gone") {
  for (const bool nodes_first : {true, false}) {
    CAPTURE(nodes_first);
    TestPlatform platform;
    std::vector<Node> nodes;
    nodes.emplace_back(platform, 1);
    nodes.emplace_back(platform, 2);
    nodes[0].tell("publisher /x 10+transient_local");
    nodes[0].tell("publish 1 10 1000");
    kill_whole(platform, nodes, nodes_first);
    REQUIRE(platform.exists());
    const std::string stray = platform.paths().directory + "/stray";
    write_file(stray, "left behind");

    const auto process = platform.join(1);
    CHECK(access(stray.c_str(), F_OK) != 0);
    CHECK(access(platform.paths().cluster(2).c_str(), F_OK) != 0);
    CHECK(process->graph().processes().size() == 1);
    CHECK(process->graph().endpoints().empty());
    const auto publisher = process->create_publisher(on_topic("/x", keep_last(1)));
    const auto subscription = process->create_subscription(on_topic("/x", transient_local(10)));
    CHECK(subscription->matched().current == 0);
  }
}

TEST_CASE("clean_platform removes a dead platform, and refuses to touch a live one") {
  TestPlatform platform;
  std::vector<Node> nodes;
  nodes.emplace_back(platform, 1);
  const Refusal refusal = refusal_of([&] { clean_platform(platform.name()); });
  CHECK(refusal.code == ErrorCode::invalid_argument);
  CHECK(refusal.says("alive"));
  CHECK(nodes[0].ask("publisher /x 1") == "ok");
  kill_whole(platform, nodes, true);
  CHECK(clean_platform(platform.name()).size() >= 4);
  CHECK_FALSE(platform.exists());
}

TEST_CASE("a look at a platform that is being created waits until it is whole") {
  const TestPlatform platform;
  const PlatformPaths paths = platform.paths();
  std::atomic<pid_t> looking{0};
  std::future<std::string> refused;
  under_join_lock(paths, [&] {
    REQUIRE(mkdir(paths.directory.c_str(), 0700) == 0);
    refused = std::async(std::launch::async, [&] {
      looking = gettid();
      std::string text = refusal_of([&] { look_at(paths); }).text;
      looking = 0;
      return text;
    });
    wait_until("it waits", [&] { return looking != 0 && is_asleep(looking); });
    ensure_platform(paths, host_profile(), {});
  });
  CHECK(refused.get() == "");
  clean_platform(platform.name());
}

TEST_CASE("a configurator keeps a platform without nodes, also in its own process") {
  TestPlatform platform;
  Profile profile = host_profile();
  profile.clusters = 3;
  profile.smem_bytes = 8 << 20;
  {
    const Configurator configurator(platform.name(), profile, {{"/x", 1, 4096, 0}});
    {
      const auto process = platform.join(3);
      CHECK(process->graph().clusters().at(0).smem_bytes == 8 << 20);
    }
    CHECK(platform.exists());
    const Refusal refusal = refusal_of([&] { Configurator second(platform.name(), profile, {}); });
    CHECK(refusal.code == ErrorCode::invalid_argument);
    CHECK(refusal.says("is running already"));
    Inspection inspection(platform);
    CHECK(inspection.registry().find_topic("/x")->topic_dsm_size == 4096);
    const Refusal cluster = refusal_of([&] { platform.join(4); });
    CHECK(cluster.code == ErrorCode::invalid_argument);
    CHECK(cluster.says("clusters 1 to 3"));
  }
  CHECK_FALSE(platform.exists());
}

TEST_CASE("a platform outlives its configurator while it has a node") {
  TestPlatform platform;
  auto configurator = std::make_unique<Configurator>(
    platform.name(), host_profile(), std::vector<TopicConfiguration>{});
  auto process = platform.join();
  configurator.reset();
  CHECK(platform.exists());
  process.reset();
  CHECK_FALSE(platform.exists());
}

TEST_CASE("a join that fails leaves nothing behind") {
  TestPlatform platform;
  Placement placement;
  placement.platform = platform.name();
  placement.cluster = 60;
  CHECK(refusal_of([&] { Process::join(placement); }).says("no cluster 60"));
  CHECK_FALSE(platform.exists());
  placement.cluster = 1;
  placement.core = 1000;
  CHECK(refusal_of([&] { Process::join(placement); }).says("no core 1000"));
  CHECK_FALSE(platform.exists());
}

TEST_CASE("a join that can start no thread leaves nothing behind") {
  TestPlatform platform;
  pthread_attr_t usual;
  REQUIRE(pthread_getattr_default_np(&usual) == 0);
  pthread_attr_t huge;
  pthread_attr_init(&huge);
  REQUIRE(pthread_attr_setstacksize(&huge, size_t{1} << 47) == 0);  // exceeds the address space
  sigset_t before;
  pthread_sigmask(SIG_SETMASK, nullptr, &before);
  const auto join_without_threads = [&] {
    REQUIRE(pthread_setattr_default_np(&huge) == 0);
    CHECK_THROWS_AS(platform.join(1), std::system_error);
    REQUIRE(pthread_setattr_default_np(&usual) == 0);
  };

  join_without_threads();
  CHECK_FALSE(platform.exists());
  const Node other(platform, 1);
  platform.receive_thread(1);  // it reaps the killed node
  for (int i = 0; i < 3; ++i) {
    join_without_threads();
  }
  Inspection inspection(platform);
  CHECK(inspection.live_processes() == 1);
  CHECK(inspection.registry().processes().high_water() == 1);
  CHECK_FALSE(has_thread("manycore_life"));
  sigset_t after;
  pthread_sigmask(SIG_SETMASK, nullptr, &after);
  CHECK(sigismember(&after, SIGINT) == sigismember(&before, SIGINT));
  pthread_attr_destroy(&huge);
  pthread_attr_destroy(&usual);
}

TEST_CASE("joining and leaving again and again leaves no descriptor open") {
  TestPlatform platform;
  platform.join();
  const size_t before = open_descriptors();
  for (int i = 0; i < 100; ++i) {
    platform.join();
    CHECK_FALSE(platform.exists());
  }
  CHECK(open_descriptors() == before);
}

TEST_CASE("a user directory open to other users, or not a directory, is refused") {
  if (!has_private_shm()) {
    MESSAGE("skipped: needs a private /dev/shm");
    return;
  }
  TestPlatform platform;
  const std::string directory = platform.paths().user_directory;
  wait_until("earlier platforms to be gone", [&] { return access(directory.c_str(), F_OK) != 0; });
  SUBCASE("open to others") {
    mkdir(directory.c_str(), 0755);
    chmod(directory.c_str(), 0755);
  }
  SUBCASE("a file") { write_file(directory, ""); }
  SUBCASE("a link to a private directory") {
    mkdir("/dev/shm/elsewhere", 0700);
    CHECK(symlink("/dev/shm/elsewhere", directory.c_str()) == 0);
  }
  const Refusal refusal = refusal_of([&] { platform.join(); });
  CHECK(refusal.code == ErrorCode::permission);
  CHECK(refusal.says(directory));
  CHECK(refusal.says("private"));
  remove(directory.c_str());
  rmdir("/dev/shm/elsewhere");
}

TEST_CASE("many processes join and leave at the same time") {
  // Cannot prove that all interleavings of joins and leaves are harmless; it meets many of them.
  TestPlatform platform;
  for (int round = 0; round < 3; ++round) {
    std::vector<std::unique_ptr<Child>> children;
    for (int i = 0; i < 12; ++i) {
      children.push_back(std::make_unique<Child>(
        "node", Arguments{platform.name(), std::to_string(1 + i % 2), "block"}));
      children.back()->say("publisher /x 1");
      children.back()->say("leave");
    }
    for (const auto & child : children) {
      CHECK(child->wait() == 0);
    }
  }
}
