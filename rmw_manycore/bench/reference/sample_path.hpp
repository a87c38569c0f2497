// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>

#include "bench/reference/message.hpp"
#include "bench/reference/statistic.hpp"

namespace manycore::bench::reference {

/// Report of a command node for each message: its path, and statistics of all messages so far.
class SamplePath {
public:
  explicit SamplePath(std::string node_name) : node_name_(std::move(node_name)) {}

  /// Adds a message and returns the report.
  std::string add(const Message & message, uint64_t timestamp_ns, uint32_t missed);

private:
  std::string table(const Message & message);
  std::string row(
    size_t order, uint64_t timestamp_ns, const std::string & number, const std::string & name,
    uint32_t dropped);
  std::string statistics(const Message & message, uint64_t timestamp_ns);
  std::string hot_path(const Message & message, const Record & sink);
  void add_period(const Record & planner);

  std::string node_name_;
  unsigned messages_ = 0;
  Statistic latency_{"ms"};
  Statistic hot_path_latency_{"ms"};
  Statistic hot_path_drops_;
  Statistic period_{"ms"};
  uint64_t planner_timestamp_ns_ = 0;
  uint32_t planner_sequence_ = 0;
  std::map<std::string, Statistic> dropped_;
};

}  // namespace manycore::bench::reference
