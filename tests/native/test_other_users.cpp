// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Files and directories of other users: they are neither mapped, written nor removed, and neither
// are the targets of links.
#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>

#include "messages.hpp"
#include "platform/pipe.hpp"
#include "platform/private_directory.hpp"
#include "platform/shared_memory.hpp"
#include "platform_of_test.hpp"
#include "private_shm.hpp"
#include "transport/lifecycle/cleaning.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/registry/registry.hpp"
#include "waiting.hpp"

using namespace manycore;
namespace fs = std::filesystem;

namespace {

constexpr uid_t other_user = 12345;

/// A private directory with a segment and a pipe.
struct Files {
  Files() {
    SharedMemory::create(segment, page_bytes);
    Pipe::create(pipe);
  }
  ~Files() { fs::remove_all(directory); }

  std::string name = "/dev/shm/files-XXXXXX";
  std::string directory = mkdtemp(name.data());
  std::string segment = directory + "/segment";
  std::string pipe = directory + "/pipe";
};

void check_refused(const std::function<void()> & act, const std::string & path) {
  const Refusal refusal = refusal_of(act);
  CHECK(refusal.code == ErrorCode::permission);
  CHECK_MESSAGE(refusal.says(path), refusal.text);
  CHECK_MESSAGE(refusal.says("of this user; remove it"), refusal.text);
}

void give_away(const std::string & path) {
  REQUIRE(lchown(path.c_str(), other_user, other_user) == 0);
}

}  // namespace

TEST_CASE("segments and pipes of another user, or open to others, are not opened") {
  Files files;
  const std::string paths[] = {files.segment, files.pipe};
  SUBCASE("open to others") {
    for (const std::string & path : paths) {
      chmod(path.c_str(), 0640);
    }
  }
  SUBCASE("links") {
    for (const std::string & path : paths) {
      fs::rename(path, path + "-target");
      fs::create_symlink(path + "-target", path);
    }
  }
  SUBCASE("another user's") {
    if (geteuid() != 0) {
      return;
    }
    for (const std::string & path : paths) {
      give_away(path);
    }
  }
  check_refused([&] { SharedMemory::open(files.segment, 1); }, files.segment);
  check_refused([&] { Pipe::open(files.pipe); }, files.pipe);
}

TEST_CASE("nothing is opened or created in a directory that is not private") {
  Files files;
  const std::string link = files.directory + "-link";
  std::string directory = files.directory;
  SUBCASE("open to others") { chmod(directory.c_str(), 0711); }
  SUBCASE("a link") {
    fs::create_symlink(directory, link);
    directory = link;
  }
  SUBCASE("another user's") {
    if (geteuid() != 0) {
      return;
    }
    give_away(directory);
  }
  check_refused([&] { SharedMemory::open(directory + "/segment", 1); }, directory);
  check_refused([&] { SharedMemory::create(directory + "/new", 1); }, directory);
  check_refused([&] { Pipe::open(directory + "/pipe"); }, directory);
  CHECK_FALSE(fs::exists(directory + "/new"));
  fs::remove(link);
}

TEST_CASE("memory of another user is not attached") {
  if (geteuid() != 0) {
    return;
  }
  const SharedMemory memory = SharedMemory::anonymous("test", page_bytes);
  CHECK(SharedMemory::attach(memory.shared_path()).size() == page_bytes);
  REQUIRE(chown(memory.shared_path().c_str(), other_user, other_user) == 0);
  const Refusal refusal = refusal_of([&] { SharedMemory::attach(memory.shared_path()); });
  CHECK(refusal.code == ErrorCode::permission);
  CHECK(refusal.says("belongs to another user"));
}

TEST_CASE("a platform's directory that is a link is not followed, and its target stays whole") {
  const Files target;
  const TestPlatform neighbour;
  const auto process = neighbour.join();  // keeps the user directory
  const TestPlatform platform;
  const std::string directory = platform.paths().directory;
  fs::create_directory_symlink(target.directory, directory);
  Placement placement;
  placement.platform = platform.name();
  check_refused([&] { Process::join(placement); }, directory);
  check_refused([&] { Configurator(platform.name(), host_profile(), {}); }, directory);
  check_refused([&] { clean_platform(platform.name()); }, directory);
  check_refused([&] { Registry(platform.paths()); }, directory);
  CHECK(fs::exists(target.segment));
  CHECK(fs::exists(target.pipe));
  for (const std::string & name : platform_names()) {
    CHECK(name != platform.name());
  }
  fs::remove(directory);
}

TEST_CASE("what another user put in the place of the user directory is refused everywhere") {
  if (!has_private_shm() || geteuid() != 0) {
    MESSAGE("skipped: needs root and a private /dev/shm");
    return;
  }
  const std::string name = "refused";
  const PlatformPaths paths = PlatformPaths::of(name);
  const std::string & directory = paths.user_directory;
  wait_until("earlier platforms to be gone", [&] { return !fs::exists(directory); });
  const std::string theirs = "/dev/shm/theirs";
  SUBCASE("a directory") { fs::create_directory(directory); }
  SUBCASE("a link to a directory") {
    fs::create_directory(theirs);
    fs::create_symlink(theirs, directory);
  }
  give_away(directory);
  Placement placement;
  placement.platform = name;
  check_refused([&] { Process::join(placement); }, directory);
  check_refused([] { platform_names(); }, directory);
  check_refused([&] { clean_platform(name); }, directory);
  check_refused([&] { PlatformPaths::of(name); }, directory);
  check_refused([&] { under_join_lock(paths, [] {}); }, directory);
  CHECK(fs::is_empty(fs::exists(theirs) ? theirs : directory));
  fs::remove_all(directory);
  fs::remove_all(theirs);
}
