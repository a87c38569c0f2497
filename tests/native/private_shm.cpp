// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "private_shm.hpp"

#include <sched.h>
#include <sys/mount.h>
#include <sys/statvfs.h>

#include "waiting.hpp"

namespace {

bool is_private = false;

}  // namespace

void enter_private_shm() {
  is_private = unshare(CLONE_NEWNS) == 0 &&
               mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               mount("tmpfs", "/dev/shm", "tmpfs", MS_NOSUID | MS_NODEV, "mode=1777") == 0;
}

bool has_private_shm() noexcept { return is_private; }

void wait_until_private_shm_is_free() {
  wait_until("the memory of former platforms is free", [] {
    struct statvfs fs {};
    return statvfs("/dev/shm", &fs) == 0 && fs.f_bfree == fs.f_blocks;
  });
}
