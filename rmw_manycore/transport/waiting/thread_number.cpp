// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/waiting/thread_number.hpp"

#include <atomic>

namespace manycore {
namespace {

constexpr uint32_t numbers_per_part = 64;
constexpr uint32_t parts = (unique_thread_numbers + numbers_per_part - 1) / numbers_per_part;

/// Atomics instead of a mutex, which a child of fork() could find locked forever.
std::atomic<uint64_t> taken[parts];
std::atomic<uint32_t> next_shared{0};

/// Mask of the numbers in a part.
constexpr uint64_t all_of(uint32_t part) {
  return unique_thread_numbers - part * numbers_per_part >= numbers_per_part
           ? ~uint64_t{0}
           : (uint64_t{1} << unique_thread_numbers % numbers_per_part) - 1;
}

class ThreadNumber {
public:
  ThreadNumber() noexcept {
    for (uint32_t part = 0; part < parts; ++part) {
      uint64_t known = taken[part].load(std::memory_order_relaxed);
      while (known != all_of(part)) {
        const uint64_t lowest = ~known & (known + 1);
        if (taken[part].compare_exchange_weak(known, known | lowest)) {
          value_ = part * numbers_per_part + static_cast<uint32_t>(__builtin_ctzll(lowest));
          return;
        }
      }
    }
    constexpr uint32_t shared = thread_numbers - unique_thread_numbers;
    value_ = unique_thread_numbers + next_shared.fetch_add(1) % shared;
  }
  ~ThreadNumber() {
    if (!is_shared_number(value_)) {
      taken[value_ / numbers_per_part].fetch_and(~(uint64_t{1} << value_ % numbers_per_part));
    }
  }
  ThreadNumber(const ThreadNumber &) = delete;
  ThreadNumber & operator=(const ThreadNumber &) = delete;

  uint32_t value() const noexcept { return value_; }

private:
  uint32_t value_ = 0;
};

}  // namespace

uint32_t thread_number() noexcept {
  thread_local const ThreadNumber number;
  return number.value();
}

}  // namespace manycore
