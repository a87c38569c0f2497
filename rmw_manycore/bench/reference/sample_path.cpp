// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "bench/reference/sample_path.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace manycore::bench::reference {

namespace {

constexpr std::array hot_path_roots = {"FrontLidarDriver", "RearLidarDriver"};
constexpr auto * hot_path_sink = "ObjectCollisionEstimator";
constexpr std::array hot_path_nodes = {
  "FrontLidarDriver", "RearLidarDriver", "PointsTransformerFront",   "PointsTransformerRear",
  "PointCloudFusion", "RayGroundFilter", "EuclideanClusterDetector", "ObjectCollisionEstimator"};
constexpr auto * planner_name = "BehaviorPlanner";
// The first messages are not counted, because nodes are still starting.
constexpr unsigned uncounted = 9;
constexpr double ns_per_ms = 1e6;
constexpr auto * rule = "----------------------------------------------------------";

std::string name_of(const Record & record) {
  return reinterpret_cast<const char *>(record.node_name);
}

const Record * find(const Message & message, const std::string & name) {
  const Record * const end = message.stats + message.size;
  const Record * const found = std::find_if(
    message.stats, end, [&](const Record & record) { return name_of(record) == name; });
  return found == end ? nullptr : found;
}

}  // namespace

std::string SamplePath::add(const Message & message, uint64_t timestamp_ns, uint32_t missed) {
  ++messages_;
  std::string text = std::string(rule) + "\nsample path: (" + node_name_ + ")\n" + table(message) +
                     row(message.size, timestamp_ns, "endpoint", node_name_, missed);
  if (messages_ > uncounted && message.size > 0) {
    text += "\nStatistics:\n" + statistics(message, timestamp_ns);
  }
  return text + rule + "\n\n";
}

std::string SamplePath::table(const Message & message) {
  std::set<uint64_t> timestamps;
  for (uint64_t i = 0; i < message.size; ++i) {
    timestamps.insert(message.stats[i].timestamp);
  }
  std::string text =
    "  order timepoint           sequence nr.                  node name     dropped samples\n";
  for (uint64_t i = 0; i < message.size; ++i) {
    const Record & record = message.stats[i];
    const auto place = timestamps.find(record.timestamp);
    text += row(
      static_cast<size_t>(std::distance(timestamps.begin(), place)), record.timestamp,
      std::to_string(record.sequence_number), name_of(record), record.dropped_samples);
  }
  return text;
}

std::string SamplePath::row(
  size_t order, uint64_t timestamp_ns, const std::string & number, const std::string & name,
  uint32_t dropped) {
  Statistic & statistic = dropped_[name];
  statistic.add(dropped);
  char head[160];
  std::snprintf(
    head, sizeof(head), "  [%2zu]  %llu  %10s    %24s     ", order,
    static_cast<unsigned long long>(timestamp_ns), number.c_str(), name.c_str());
  return head + statistic.text() + "\n";
}

std::string SamplePath::statistics(const Message & message, uint64_t timestamp_ns) {
  const Record * const oldest = std::min_element(
    message.stats, message.stats + message.size,
    [](const Record & one, const Record & other) { return one.timestamp < other.timestamp; });
  latency_.add(static_cast<double>(timestamp_ns - oldest->timestamp) / ns_per_ms);
  std::string text = "  latency:                  " + latency_.text() + "\n";
  if (const Record * const sink = find(message, hot_path_sink)) {
    text += hot_path(message, *sink);
  }
  if (const Record * const planner = find(message, planner_name)) {
    add_period(*planner);
    if (!period_.is_empty()) {
      text += "  behavior planner period:  " + period_.text() + "\n";
    }
  }
  return text;
}

std::string SamplePath::hot_path(const Message & message, const Record & sink) {
  uint64_t started_ns = 0;
  for (const char * root : hot_path_roots) {
    const Record * const record = find(message, root);
    started_ns = record ? std::max(started_ns, record->timestamp) : started_ns;
  }
  uint32_t drops = 0;
  for (const char * name : hot_path_nodes) {
    const Record * const record = find(message, name);
    drops += record ? record->dropped_samples : 0;
  }
  hot_path_latency_.add(static_cast<double>(sink.timestamp - started_ns) / ns_per_ms);
  hot_path_drops_.add(drops);
  return "  hot path:                 " + std::string(hot_path_roots[0]) + "/" + hot_path_roots[1] +
         " -> " + hot_path_sink + "\n  hot path latency:         " + hot_path_latency_.text() +
         "\n  hot path drops:           " + hot_path_drops_.text() + "\n";
}

void SamplePath::add_period(const Record & planner) {
  if (planner_timestamp_ns_ != 0 && planner.sequence_number > planner_sequence_) {
    period_.add(
      static_cast<double>(planner.timestamp - planner_timestamp_ns_) /
      (planner.sequence_number - planner_sequence_) / ns_per_ms);
  }
  planner_timestamp_ns_ = planner.timestamp;
  planner_sequence_ = planner.sequence_number;
}

}  // namespace manycore::bench::reference
