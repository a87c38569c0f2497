// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace manycore::bench {

/// Arguments `name=value` of a command line.
class Arguments {
public:
  Arguments(int argc, char ** argv) {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      const size_t equals = word.find('=');
      if (equals == std::string::npos) {
        throw std::invalid_argument("expected name=value, found " + word);
      }
      values_[word.substr(0, equals)] = word.substr(equals + 1);
    }
  }

  const std::string & text(const std::string & name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) {
      throw std::invalid_argument("missing argument " + name + "=");
    }
    return found->second;
  }

  size_t number(const std::string & name) const { return std::stoul(text(name)); }

  /// The parts of a text between commas.
  std::vector<std::string> list(const std::string & name) const {
    std::vector<std::string> parts;
    std::istringstream words(text(name));
    for (std::string part; std::getline(words, part, ',');) {
      parts.push_back(part);
    }
    return parts;
  }

private:
  std::map<std::string, std::string> values_;
};

}  // namespace manycore::bench
