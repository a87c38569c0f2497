// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <vector>

#include "child.hpp"

/// Plays a role as the first process of a PID namespace, as in a container. It is killed with the
/// process that contains it.
inline const Role contained("contained", [](Lines & test, const Arguments & arguments) {
  if (unshare(CLONE_NEWPID) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWPID) != 0) {
    manycore::throw_errno("cannot make a PID namespace");
  }
  const pid_t inner = fork();
  if (inner == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    std::vector<char *> argv{const_cast<char *>("contained"), const_cast<char *>("--role")};
    for (const std::string & argument : arguments) {
      argv.push_back(const_cast<char *>(argument.c_str()));
    }
    argv.push_back(nullptr);
    execv("/proc/self/exe", argv.data());
  }
  test.say("contains");
  int status = 0;
  waitpid(inner, &status, 0);
  // At once: a leak sanitizer would fail, since no process can be created where the first has
  // ended.
  _exit(WIFEXITED(status) ? WEXITSTATUS(status) : EXIT_FAILURE);
});
