// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>

namespace manycore::bench {

/// The words `name=value` of a command line.
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

private:
  std::map<std::string, std::string> values_;
};

}  // namespace manycore::bench
