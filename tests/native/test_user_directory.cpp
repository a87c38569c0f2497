// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The directory that holds platforms: selection by MANYCORE_DIRECTORY, and how much of its file
// system a cluster gets.
#include <doctest/doctest.h>

#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "messages.hpp"
#include "node_role.hpp"
#include "private_shm.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr const char * variable = "MANYCORE_DIRECTORY";

/// A private directory that this program and its children use during the object's lifetime.
class Chosen {
public:
  Chosen() {
    REQUIRE(mkdtemp(&path_[0]) != nullptr);
    setenv(variable, path_.c_str(), 1);
  }
  ~Chosen() {
    unsetenv(variable);
    std::filesystem::remove_all(path_);
  }
  const std::string & path() const noexcept { return path_; }

private:
  std::string path_ = "/dev/shm/chosen-XXXXXX";
};

/// As Chosen, with a separate file system mounted on it.
class ChosenMount : public Chosen {
public:
  explicit ChosenMount(const char * type, const char * options = "mode=700") {
    REQUIRE(mount("none", path().c_str(), type, 0, options) == 0);
    chmod(path().c_str(), 0700);
  }
  ~ChosenMount() { umount2(path().c_str(), MNT_DETACH); }
};

void check_refused(const std::string & what, ErrorCode code) {
  Placement placement;
  placement.platform = "refused";
  const Refusal refusal = refusal_of([&] { Process::join(placement); });
  CHECK(refusal.code == code);
  CHECK_MESSAGE(refusal.says(variable), refusal.text);
  CHECK_MESSAGE(refusal.says(what), refusal.text);
  CHECK(refusal.text.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("a platform lies in the chosen directory, its children find it there, and it stays") {
  const Chosen chosen;
  {
    TestPlatform platform;
    const auto process = platform.join();
    const auto publisher = process->create_publisher(on_topic("/x", keep_last(10)));
    Node node(platform, 2);
    node.tell("subscription /x 10");
    publish(*publisher, 1);
    node.tell("take 1 1 1");
    platform.receive_thread(2);
    CHECK(platform.paths().directory == chosen.path() + "/" + platform.name());
    CHECK(access((chosen.path() + "/" + platform.name() + "/registry").c_str(), F_OK) == 0);
    CHECK(platform_names() == std::vector<std::string>{platform.name()});
  }
  CHECK(std::filesystem::is_empty(chosen.path()));
}

TEST_CASE("the chosen directory is removed while nodes run: all notice, and none waits for it") {
  const Chosen chosen;
  const TestPlatform platform;
  Node other(platform, 2);
  {
    const auto process = platform.join();
    const pid_t receive_threads[] = {platform.receive_thread(1), platform.receive_thread(2)};
    remove_used(chosen.path());
    for (const pid_t pid : receive_threads) {
      wait_until("the receive threads have ended", [&] { return !is_running(pid); });
    }
    wait_until("the member notices", [&] { return process->is_cut_off(); });
  }
  check_refused(chosen.path(), ErrorCode::invalid_argument);
  REQUIRE(mkdir(chosen.path().c_str(), 0700) == 0);  // for the check that nothing is left
}

TEST_CASE("a trailing slash of the chosen directory is ignored") {
  const Chosen chosen;
  setenv(variable, (chosen.path() + "//").c_str(), 1);
  CHECK(PlatformPaths::of("a").registry() == chosen.path() + "/a/registry");
}

TEST_CASE("the chosen directory may be a link, which is resolved once") {
  const Chosen chosen;
  const std::string link = chosen.path() + "-link";
  std::filesystem::create_directory_symlink(chosen.path(), link);
  setenv(variable, link.c_str(), 1);
  {
    const TestPlatform platform;
    const auto process = platform.join();
    CHECK(platform.paths().registry().rfind(chosen.path() + "/", 0) == 0);
  }
  std::filesystem::remove(link);
}

TEST_CASE("an unsuitable chosen directory is refused, in one line that says what to do") {
  const Chosen chosen;
  const std::string path = chosen.path();
  SUBCASE("not there") {
    setenv(variable, (path + "/no").c_str(), 1);
    const std::string advice = "`mkdir -p -m 700 '" + path + "/no'`";
    check_refused(advice, ErrorCode::invalid_argument);
    CHECK(refusal_of([] { platform_names(); }).says(advice));
  }
  SUBCASE("behind a file") {
    setenv(variable, "/etc/passwd/no", 1);
    check_refused("(Not a directory); choose another one", ErrorCode::invalid_argument);
  }
  SUBCASE("not absolute") {
    setenv(variable, "chosen", 1);
    check_refused("is not an absolute path", ErrorCode::invalid_argument);
  }
  SUBCASE("a file") {
    setenv(variable, "/etc/passwd", 1);
    check_refused("is not a directory", ErrorCode::invalid_argument);
  }
  SUBCASE("open to others") {
    chmod(path.c_str(), 0750);
    check_refused("(mode 750): `chmod 700 '" + path + "'`", ErrorCode::permission);
  }
  SUBCASE("for all users, as /tmp is") {
    chmod(path.c_str(), 01777);
    check_refused("(mode 777): `mkdir -p -m 700 '" + path, ErrorCode::permission);
  }
  SUBCASE("another user's") {
    if (geteuid() == 0) {
      CHECK(chown(path.c_str(), 12345, 12345) == 0);
      check_refused("belongs to user 12345; choose", ErrorCode::permission);
    }
  }
}

TEST_CASE("a chosen directory on an unsuitable file system is refused") {
  if (!has_private_shm()) {
    return;  // mounting is not permitted
  }
  SUBCASE("read-only") {
    const ChosenMount chosen("tmpfs");
    CHECK(mount(nullptr, chosen.path().c_str(), nullptr, MS_REMOUNT | MS_RDONLY, nullptr) == 0);
    check_refused("cannot be written to", ErrorCode::permission);
  }
  SUBCASE("a file system that gives no memory back") {
    const ChosenMount chosen("ramfs");
    check_refused("cannot reserve memory (fallocate)", ErrorCode::unsupported);
    CHECK(std::filesystem::is_empty(chosen.path()));
  }
}

TEST_CASE("clusters of the host are sized by the file system of the chosen directory") {
  if (!has_private_shm()) {
    return;  // mounting is not permitted
  }
  const ChosenMount chosen("tmpfs", "mode=700,size=64m");
  CHECK(host_profile().smem_bytes == 48 << 20);
}

TEST_CASE("each cluster of the host has a share; if that is small, what the others leave") {
  constexpr uint64_t mebibyte = 1 << 20;
  struct Row {
    uint64_t shared;  // MiB, like the SMEM
    uint64_t smem;
  };
  for (const Row row : {Row{0, 1024}, {1, 1}, {64, 48}, {2048, 1024}, {24 * 1024, 2457}}) {
    CAPTURE(row.shared);
    CHECK(host_smem_bytes(row.shared * mebibyte, 5) == row.smem * mebibyte);
  }
}
