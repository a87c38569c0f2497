// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Damaged files of a platform: a joining process gets an error that says what to do, or works; no
// process crashes or hangs. Random damage is only a sample. A file that is truncated while it is
// mapped ends its users with SIGBUS, which the kernel makes unavoidable.
#include <doctest/doctest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include "messages.hpp"
#include "node_role.hpp"
#include "transport/layout/registry_layout.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/layout/topic_dsm_layout.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

using Bytes = std::vector<char>;

/// Joins, uses everything briefly, and leaves.
const Role visitor("visitor", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  process->remove_node(process->add_node("visitor", "/", "/"));
  const auto publisher = process->create_publisher(on_topic("/x", transient_local(10)));
  const auto subscription = process->create_subscription(on_topic("/x", transient_local(10)));
  for (uint64_t number = 1; number <= 20; ++number) {
    publish(*publisher, number, 2000);
    while (subscription->claim()) {
    }
  }
  process->graph().endpoints();
  process->graph().processes();
  test.say("got along");
});

/// Damages the blocks of its publisher's table of seats as requested, and closes the publisher.
const Role table_breaker("table_breaker", [](Lines & test, const Arguments & arguments) {
  const auto process = join_platform(arguments.at(0));
  auto publisher = process->create_publisher(on_topic("/table", keep_last(1)));
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (uint32_t i = 0; i <= seats_in_header; ++i) {
    subscriptions.push_back(process->create_subscription(on_topic("/table", keep_last(1))));
  }
  publish(*publisher, 1);
  Registry registry(PlatformPaths::of(arguments.at(0)));
  const auto slot = static_cast<uint32_t>(endpoint_in(publisher->gid()));
  const uint64_t offset = registry.endpoints()[slot].block.offset();
  EntryBlocks & blocks = registry.clusters().at(1).find<TopicDsmHeader>(offset)->further_seats;
  if (arguments.at(1) == "leads out") {
    blocks.offsets[0] = uint64_t{1} << 40;
  } else {
    blocks.offsets[1] = blocks.offsets[0].load();
  }
  publisher.reset();
  subscriptions.clear();
  test.say("got along");
});

/// Result of a visit: "got along", or "error: ..". Throws if the visitor crashed or hangs.
std::string outcome_of(Child child) {
  const std::string outcome = child.hear();
  const int status = child.wait();
  if (status < 0) {
    throw std::runtime_error("killed by signal " + std::to_string(-status));
  }
  return outcome;
}

std::string visit(const TestPlatform & platform) {
  return outcome_of(Child("visitor", {platform.name()}));
}

Bytes read_file(const std::string & path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Replaces a file in use by another one; processes that have mapped the old file keep using it.
void replace_file(const std::string & path, const Bytes & content) {
  const std::string fresh = path + ".new";
  std::ofstream(fresh, std::ios::binary).write(content.data(), static_cast<long>(content.size()));
  chmod(fresh.c_str(), 0600);
  CHECK(std::rename(fresh.c_str(), path.c_str()) == 0);
}

/// A platform with one node; small, so that its segments are read and written quickly.
struct Fixture {
  Fixture() {
    Profile profile = host_profile();
    profile.smem_bytes = 1 << 20;
    configurator =
      std::make_unique<Configurator>(platform.name(), profile, std::vector<TopicConfiguration>{});
    node = std::make_unique<Node>(platform, 1);
    node->tell("publisher /x 10+transient_local");
    node->tell("publish 1 10 1000");
    receive_thread = platform.receive_thread(1);
  }
  /// The reaper cannot be expected to clean up damaged files.
  ~Fixture() {
    node.reset();
    kill(receive_thread, SIGKILL);
    wait_until("its end", [&] { return !is_running(receive_thread); });
    configurator.reset();
    under_join_lock(platform.paths(), [this] { remove_platform(platform.paths()); });
  }

  TestPlatform platform;
  std::unique_ptr<Configurator> configurator;
  std::unique_ptr<Node> node;
  pid_t receive_thread;
};

std::mt19937 random_bits{7};

Bytes random_bytes(size_t size) {
  Bytes bytes(size);
  std::generate(bytes.begin(), bytes.end(), [] { return static_cast<char>(random_bits()); });
  return bytes;
}

struct Damage {
  const char * name;
  Bytes (*apply)(const Bytes & content);
};

Bytes with_word(Bytes content, size_t offset, uint32_t word) {
  std::memcpy(content.data() + offset, &word, sizeof word);
  return content;
}

Bytes cut(Bytes content, size_t size) {
  content.resize(size);
  return content;
}

constexpr Damage damages[] = {
  {"empty", [](const Bytes &) { return Bytes(); }},
  {"cut in the header", [](const Bytes & content) { return cut(content, 10); }},
  {"cut in the middle", [](const Bytes & content) { return cut(content, content.size() / 2); }},
  {"a byte too long", [](const Bytes & content) { return cut(content, content.size() + 1); }},
  {"zeroed", [](const Bytes & content) { return Bytes(content.size()); }},
  {"random", [](const Bytes & content) { return random_bytes(content.size()); }},
  {"of no magic", [](const Bytes & content) { return with_word(content, 0, 1); }},
  {"of another layout", [](const Bytes & content) { return with_word(content, 8, 99); }},
};

}  // namespace

TEST_CASE("a damaged registry or cluster segment is refused, with the file's name and what to do") {
  for (const Damage & damage : damages) {
    for (const bool of_registry : {true, false}) {
      const std::string what = damage.name;
      CAPTURE(what);
      CAPTURE(of_registry);
      Fixture f;
      const std::string path =
        of_registry ? f.platform.paths().registry() : f.platform.paths().cluster(1);
      const Bytes sound = read_file(path);
      replace_file(path, damage.apply(sound));
      const std::string outcome = visit(f.platform);
      CHECK_MESSAGE(outcome.find("error: " + path) == 0, outcome);
      CHECK_MESSAGE(outcome.find("manycore clean") != std::string::npos, outcome);
    }
  }
}

TEST_CASE("a segment of another platform is refused") {
  Fixture f;
  Fixture other;
  replace_file(f.platform.paths().cluster(1), read_file(other.platform.paths().cluster(1)));
  const std::string outcome = visit(f.platform);
  CHECK_MESSAGE(outcome.find("belongs to another platform") != std::string::npos, outcome);
}

TEST_CASE("an object of another kind in place of a file is refused") {
  for (const bool is_pipe : {true, false}) {
    for (const std::string kind : {"file", "directory", "link", "pipe"}) {
      if (kind == "pipe" && is_pipe) {
        continue;
      }
      CAPTURE(is_pipe);
      CAPTURE(kind);
      Fixture f;
      const PlatformPaths paths = f.platform.paths();
      const std::string path = is_pipe ? paths.pipe(1) : paths.cluster(1);
      unlink(path.c_str());
      if (kind == "file") {
        replace_file(path, {});
      } else if (kind == "directory") {
        mkdir(path.c_str(), 0700);
      } else if (kind == "link") {
        CHECK(symlink("/dev/zero", path.c_str()) == 0);
      } else {
        CHECK(mkfifo(path.c_str(), 0600) == 0);
      }
      const std::string outcome = visit(f.platform);
      CHECK_MESSAGE(outcome.find("error: ") == 0, outcome);
      CHECK_MESSAGE(outcome.find(path) != std::string::npos, outcome);
      rmdir(path.c_str());
    }
  }
}

TEST_CASE("random words in the tables of a registry in use: visitors succeed or get an error") {
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    Fixture f;
    const std::string path = f.platform.paths().registry();
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    // The header, and the used part of each table.
    const uint64_t parts[] = {
      sizeof(SegmentHeader), process_table_offset, node_table_offset, endpoint_table_offset};
    const uint64_t part = parts[random_bits() % 4];
    const uint64_t extent = part == parts[0] ? process_table_offset - part : 2048;
    for (int words = 1 + static_cast<int>(random_bits() % 50); words > 0; --words) {
      file.seekp(static_cast<long>(part + random_bits() % (extent / 4) * 4));
      const auto word = static_cast<uint32_t>(random_bits());
      file.write(reinterpret_cast<const char *>(&word), sizeof word);
    }
    file.close();
    CHECK_NOTHROW(visit(f.platform));
  }
}

TEST_CASE("random words in a cluster segment in use: visitors succeed or get an error") {
  for (int round = 0; round < 60; ++round) {
    CAPTURE(round);
    Fixture f;
    std::fstream file(
      f.platform.paths().cluster(1), std::ios::binary | std::ios::in | std::ios::out);
    for (int words = 1 + static_cast<int>(random_bits() % 200); words > 0; --words) {
      file.seekp(static_cast<long>(sizeof(SegmentHeader) + random_bits() % (16 * 1024 / 4) * 4));
      const uint32_t word = words % 2 == 0 ? random_bits() : random_bits() % 100'000;
      file.write(reinterpret_cast<const char *>(&word), sizeof word);
    }
    file.close();
    CHECK_NOTHROW(visit(f.platform));
  }
}

TEST_CASE(
  "a memory map size damaged later: nodes keep the size that they loaded when they joined") {
  const TestPlatform platform;
  const auto process = platform.join(1);
  platform.receive_thread(1);
  Inspection inspection(platform);
  inspection.registry().clusters().at(1).header().granule_count = UINT32_MAX;
  CHECK_NOTHROW(process->create_publisher(on_topic("/x", keep_last(1))));
}

TEST_CASE(
  "a table with a block outside its cluster, or the same block twice, is freed as far as "
  "possible") {
  for (const std::string damage : {"leads out", "stands twice"}) {
    CAPTURE(damage);
    Fixture f;
    CHECK(outcome_of(Child("table_breaker", {f.platform.name(), damage})) == "got along");
  }
}
