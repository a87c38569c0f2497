// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

namespace manycore::bench::reference {

/// Minimum, maximum, mean and deviation of the values added so far (Welford), formatted as in the
/// reference system's reports.
class Statistic {
public:
  explicit Statistic(std::string suffix = "") : suffix_(std::move(suffix)) {}

  void add(double value) {
    ++count_;
    current_ = value;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
    const double delta = value - average_;
    average_ += delta / count_;
    squares_ += delta * (value - average_);
  }

  bool is_empty() const { return count_ == 0; }

  std::string text() const {
    return shown(current_) + " [min=" + shown(low_) + ", max=" + shown(high_) +
           ", average=" + shown(average_) +
           ", deviation=" + shown(std::sqrt(squares_ / (count_ - 1))) + "]";
  }

private:
  std::string shown(double value) const {
    char digits[32];
    // The deviation of a single value is nan, and its sign is meaningless.
    std::snprintf(digits, sizeof(digits), "%g", std::isnan(value) ? std::abs(value) : value);
    return digits + suffix_;
  }

  std::string suffix_;
  double count_ = 0;
  double current_ = 0;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
  double average_ = 0;
  double squares_ = 0;
};

}  // namespace manycore::bench::reference
