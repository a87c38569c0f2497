// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlfcn.h>

namespace manycore::virtual_time {

/// Releases Python's global lock, if the calling thread holds it: rclpy publishes and takes with
/// it, and a thread that is let go in between may need it.
class PythonUnlocked {
public:
  PythonUnlocked() noexcept {
    static auto * const is_initialized = function<int()>("Py_IsInitialized");
    static auto * const is_held = function<int()>("PyGILState_Check");
    static auto * const release = function<void *()>("PyEval_SaveThread");
    if (is_initialized != nullptr && is_initialized() != 0 && is_held() != 0) {
      thread_ = release();
    }
  }
  ~PythonUnlocked() {
    static auto * const take = function<void(void *)>("PyEval_RestoreThread");
    if (thread_ != nullptr) {
      take(thread_);
    }
  }
  PythonUnlocked(const PythonUnlocked &) = delete;
  PythonUnlocked & operator=(const PythonUnlocked &) = delete;

private:
  template<typename Function>
  static Function * function(const char * name) noexcept {
    return reinterpret_cast<Function *>(dlsym(RTLD_DEFAULT, name));
  }

  void * thread_ = nullptr;
};

}  // namespace manycore::virtual_time
