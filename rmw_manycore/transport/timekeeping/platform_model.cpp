// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/timekeeping/platform_model.hpp"

#include <array>
#include <sstream>

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
  Answer answer{until_ns, std::nullopt};
  while (true) {
    std::istringstream words(next_line());
    std::string verb;
    words >> verb;
    if (verb == "under_way" || verb == "arrived") {
      Passage passage{verb == "arrived", {}, {}};
      words >> passage.topic >> passage.node;
      answer.passages.push_back(passage);
      continue;
    }
    words >> answer.at_ns;
    Thread thread{};
    if (words >> thread.seat >> thread.tid) {
      answer.done = thread;
    }
    answer.is_waiting = verb != "none";
    return answer;
  }
}

std::string PlatformModel::next_line() {
  std::array<char, 1024> line{};  // two names of at most 255 characters
  if (std::fgets(line.data(), line.size(), from_.get()) == nullptr) {
    throw Error(ErrorCode::invalid_argument, "the model of the platform has ended");
  }
  return line.data();
}

void PlatformModel::resume() { tell("resume"); }

}  // namespace manycore
