// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "private_shm.hpp"

#include <sched.h>
#include <sys/mount.h>

namespace {

bool is_private = false;

}  // namespace

void enter_private_shm() {
  is_private = unshare(CLONE_NEWNS) == 0 &&
               mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               mount("tmpfs", "/dev/shm", "tmpfs", MS_NOSUID | MS_NODEV, "mode=1777") == 0;
}

bool has_private_shm() noexcept { return is_private; }
