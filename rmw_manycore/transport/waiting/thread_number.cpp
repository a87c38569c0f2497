// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/waiting/thread_number.hpp"

#include <atomic>

namespace manycore {
namespace {

constexpr uint64_t all_numbers = (uint64_t{1} << thread_numbers) - 1;

/// No mutex guards them: a child of fork() could find it locked for ever.
std::atomic<uint64_t> taken{0};
std::atomic<uint32_t> sharing{0};  ///< threads that found all numbers taken
std::atomic<uint32_t> next_shared{0};

class ThreadNumber {
public:
  ThreadNumber() noexcept {
    uint64_t known = taken.load(std::memory_order_relaxed);
    while (known != all_numbers) {
      const uint64_t lowest = ~known & (known + 1);
      if (taken.compare_exchange_weak(known, known | lowest)) {
        value_ = static_cast<uint32_t>(__builtin_ctzll(lowest));
        return;
      }
    }
    shares_ = true;
    sharing.fetch_add(1);
    value_ = next_shared.fetch_add(1) % thread_numbers;
  }
  ~ThreadNumber() {
    if (shares_) {
      sharing.fetch_sub(1);
    } else {
      taken.fetch_and(~(uint64_t{1} << value_));
    }
  }
  ThreadNumber(const ThreadNumber &) = delete;
  ThreadNumber & operator=(const ThreadNumber &) = delete;

  uint32_t value() const noexcept { return value_; }

private:
  uint32_t value_ = 0;
  bool shares_ = false;
};

}  // namespace

uint32_t thread_number() noexcept {
  thread_local const ThreadNumber number;
  return number.value();
}

bool are_thread_numbers_shared() noexcept { return sharing.load() != 0; }

}  // namespace manycore
