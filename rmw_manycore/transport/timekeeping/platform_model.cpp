// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/timekeeping/platform_model.hpp"

#include <array>
#include <cinttypes>

#include "platform/error.hpp"

namespace manycore {

PlatformModel::PlatformModel(int to, int from) : to_(fdopen(to, "w")), from_(fdopen(from, "r")) {
  if (!to_ || !from_) {
    throw Error(ErrorCode::invalid_argument, "the pipes to the model of the platform are not open");
  }
}

void PlatformModel::tell(const std::string & line) {
  std::fprintf(to_.get(), "%s\n", line.c_str());
}

void PlatformModel::ask(const Thread & thread, const std::string & what) {
  tell("ask " + std::to_string(thread.seat) + " " + std::to_string(thread.tid) + " " + what);
}

PlatformModel::Answer PlatformModel::advance(int64_t until_ns) {
  tell("advance " + std::to_string(until_ns));
  std::fflush(to_.get());
  std::array<char, 128> line{};
  Answer answer{until_ns, std::nullopt};
  Thread thread{};
  if (std::fgets(line.data(), line.size(), from_.get()) == nullptr) {
    throw Error(ErrorCode::invalid_argument, "the model of the platform has ended");
  }
  const int found = std::sscanf(
    line.data(), "%" SCNd64 " %" SCNu32 " %" SCNd32, &answer.at_ns, &thread.seat, &thread.tid);
  if (found == 3) {
    answer.done = thread;
  }
  return answer;
}

void PlatformModel::resume() { tell("resume"); }

}  // namespace manycore
