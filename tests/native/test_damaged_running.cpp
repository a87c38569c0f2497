// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Segments are damaged while the platform's nodes run: a node that is asked to end, ends. Its
// behaviour until then is undefined; the damage may even have killed it.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <random>
#include <thread>

#include "messages.hpp"
#include "node_role.hpp"
#include "platform/clock.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

std::atomic<bool> interrupted{false};
std::atomic<Waiter *> interrupted_waiter{nullptr};

/// Like rclpy's signal handler: notifies the process, which sleeps without a timeout.
void handle_interrupt(int) {
  interrupted = true;
  interrupted_waiter.load()->notify();
}

/// Publishes, takes, reads the graph, and sleeps until it is woken; until SIGINT.
const Role busy_node("busy_node", [](Lines & test, const Arguments & arguments) {
  const auto process =
    join_platform(arguments.at(0), static_cast<uint32_t>(std::stoul(arguments.at(1))));
  const uint32_t node = process->add_node("busy", "/", "/");
  const bool publishes = arguments.at(2) == "publishes";
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (const Qos & qos : {keep_last(3), transient_local(5), keep_all()}) {
    for (const std::string topic : {"/a", "/b"}) {
      publishers.push_back(process->create_publisher(on_topic(topic, qos)));
      subscriptions.push_back(process->create_subscription(on_topic(topic, qos)));
    }
  }
  interrupted_waiter = &process->waiters().common();
  signal(SIGINT, handle_interrupt);
  test.say("at work");
  for (uint64_t number = 1; !interrupted; ++number) {
    const uint32_t epoch = process->waiters().common().epoch();
    for (size_t i = 0; i < publishers.size() && !interrupted; ++i) {
      try {
        if (publishes) {
          publish(*publishers[i], number, 64 + number % 7 * 500);
        }
        while (!interrupted && subscriptions[i]->claim()) {
        }
      } catch (const std::exception &) {
        // damaged
      }
    }
    if (!publishes && !interrupted) {
      process->waiters().common().wait(epoch, std::nullopt);
    }
  }
  publishers.clear();
  subscriptions.clear();
  process->remove_node(node);
});

/// Overwrites words of a file with random ones.
class Damager {
public:
  explicit Damager(uint32_t seed) : random_(seed) {}

  void damage(const std::string & path, uint64_t begin, uint64_t end, uint64_t words) {
    const FileDescriptor fd(open(path.c_str(), O_RDWR));
    for (; words > 0; --words) {
      const uint64_t offset = begin + random_() % ((end - begin) / 4) * 4;
      const uint32_t word = random_() % 4 == 0 ? random_() % 64 : random_();
      REQUIRE(pwrite(fd.get(), &word, sizeof word, static_cast<off_t>(offset)) == sizeof word);
    }
  }
  /// Damages tables or header of the registry, or the used part of a cluster, in a few words or
  /// many.
  void damage_some(const PlatformPaths & paths) {
    const uint64_t words = random_() % 2 == 0 ? 1 + random_() % 20 : 20'000;
    if (random_() % 2 == 0) {
      const uint64_t tables[] = {
        sizeof(SegmentHeader), process_table_offset, endpoint_table_offset};
      const uint64_t begin = tables[random_() % 3];
      damage(paths.registry(), begin, begin + 10'000, words);
    } else {
      const uint32_t cluster = 1 + random_() % 2;
      damage(paths.cluster(cluster), sizeof(SegmentHeader), 60'000, words);
    }
  }

private:
  std::mt19937 random_;
};

struct Fixture {
  Fixture() {
    Profile profile = host_profile();
    profile.smem_bytes = 1 << 20;
    configurator =
      std::make_unique<Configurator>(platform.name(), profile, std::vector<TopicConfiguration>{});
    for (const uint32_t cluster : {1u, 2u}) {
      for (const std::string what : {"publishes", "waits"}) {
        nodes.emplace_back("busy_node", Arguments{platform.name(), std::to_string(cluster), what});
      }
    }
    for (Child & node : nodes) {
      node.expect("at work");
    }
    receive_threads = {platform.receive_thread(1), platform.receive_thread(2)};
  }
  /// The reaper cannot be expected to clean up damaged files.
  ~Fixture() {
    nodes.clear();
    for (const pid_t pid : platform.receive_threads()) {
      kill(pid, SIGKILL);
      wait_until("its end", [&] { return !is_running(pid); });
    }
    configurator.reset();
    under_join_lock(platform.paths(), [this] { remove_platform(platform.paths()); });
  }

  TestPlatform platform;
  std::unique_ptr<Configurator> configurator;
  std::vector<Child> nodes;
  std::vector<pid_t> receive_threads;
};

}  // namespace

TEST_CASE("damaged while nodes run: each ends when it is asked to") {
  const char * const rounds = std::getenv("MANYCORE_TEST_DAMAGES");
  for (uint32_t round = 0; round < (rounds == nullptr ? 25u : std::stoul(rounds)); ++round) {
    CAPTURE(round);
    Fixture f;
    Damager damager(round);
    damager.damage_some(f.platform.paths());
    usleep(2000 * (round % 10));  // the nodes meet the damage, or are asked to end at once
    for (const Child & node : f.nodes) {
      kill(node.pid(), SIGINT);
    }
    for (Child & node : f.nodes) {
      CHECK_NOTHROW(node.wait());
    }
  }
}

TEST_CASE("a process wakes its sleepers though their count in shared memory is damaged") {
  WakeWord word{};
  Waiter waiter(word, WaitMode::block);
  std::thread sleeper([&] { waiter.wait(waiter.epoch(), std::nullopt); });
  wait_until("it sleeps", [&] { return word.sleepers.load() == 1; });
  const int64_t asleep = monotonic_ns() + 10'000'000;  // counted before it sleeps
  while (monotonic_ns() < asleep) {
  }
  word.sleepers = 0;
  waiter.notify();
  sleeper.join();
  CHECK(waiter.epoch() == 1);
}

TEST_CASE("a push to a damaged queue ends, and makes the subscriber resync") {
  TestPlatform platform;
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(3)));
  const auto subscription = process->create_subscription(on_topic("/x", keep_last(3)));
  Inspection inspection(platform);
  SubscriptionHeader & header = inspection.header_of(*subscription);
  SUBCASE("head and tail far apart") { header.head = header.tail - (uint64_t{1} << 60); }
  SUBCASE("no depth") { header.depth = 0; }
  publish(*publisher, 1);
  CHECK(header.resync.load() == 1);
}

TEST_CASE("a record with a foreign number does not block its publisher") {
  TestPlatform platform;
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/x", keep_last(3)));
  Registry registry(platform.paths());
  Cluster & cluster = registry.clusters().at(1);
  auto & dsm = *cluster.find<TopicDsmHeader>(registry.endpoints()[0].block.offset());
  auto * const records = cluster.find<RecordDescriptor>(dsm.generations[0].offset);
  records[1].number = 6;
  CHECK(publish(*publisher, 1) == 1);
}
