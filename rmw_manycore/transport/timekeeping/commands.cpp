// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/timekeeping/commands.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <sstream>

namespace manycore {
namespace {

Command parse(const std::string & line) {
  std::istringstream words(line);
  std::string verb;
  Command command{Command::Kind::over};
  words >> verb;
  if (verb == "start") {
    command.kind = Command::Kind::start;
    words >> command.rank >> command.pid >> std::ws;
    std::getline(words, command.name);
  } else if (verb == "gone") {
    command.kind = Command::Kind::gone;
    words >> command.rank;
  } else if (verb == "kill" || verb == "later") {
    command.kind = verb == "kill" ? Command::Kind::kill : Command::Kind::later;
    words >> command.rank >> command.duration_ns;
  } else if (verb == "hold") {
    command.kind = Command::Kind::hold;
  } else if (verb == "resume") {
    command.kind = Command::Kind::resume;
    words >> command.duration_ns >> command.name;
  } else if (verb == "go") {
    command.kind = Command::Kind::go;
    words >> command.duration_ns;
  }
  return command;
}

}  // namespace

CommandInput::CommandInput() {
  fcntl(STDIN_FILENO, F_SETFL, fcntl(STDIN_FILENO, F_GETFL) | O_NONBLOCK);
}

std::vector<Command> CommandInput::take() {
  std::array<char, 4096> bytes;
  const ssize_t size = read(STDIN_FILENO, bytes.data(), bytes.size());
  if (size == 0) {
    return {{Command::Kind::over}};
  }
  if (size < 0) {
    return {};
  }
  unfinished_.append(bytes.data(), static_cast<size_t>(size));
  std::vector<Command> commands;
  for (size_t end = unfinished_.find('\n'); end != std::string::npos;
       end = unfinished_.find('\n')) {
    commands.push_back(parse(unfinished_.substr(0, end)));
    unfinished_.erase(0, end + 1);
  }
  return commands;
}

}  // namespace manycore
