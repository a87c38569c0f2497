// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Preloaded, lets others run for a while whenever a thread but the first has unlocked a mutex: they
// then meet it between that and its next step.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <pthread.h>
#include <sys/syscall.h>
#include <unistd.h>

int pthread_mutex_unlock(pthread_mutex_t * mutex) {
  static int (*unlock)(pthread_mutex_t *);
  if (!unlock) {
    unlock = (int (*)(pthread_mutex_t *))dlsym(RTLD_NEXT, "pthread_mutex_unlock");
  }
  const int status = unlock(mutex);
  if (syscall(SYS_gettid) != getpid()) {
    usleep(5000);
  }
  return status;
}
