// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// fuzz_deserialize SAMPLES [SEED [FIRST]]: deserializes and takes messages that are generated from
// their types and then damaged. For any bytes: no take fails, each message is taken or counted as
// lost, accepted messages can be serialized, allocations stay small, and the verdict equals that of
// Fast DDS, except for messages that Fast DDS reads only in part.
#include <fcntl.h>
#include <unistd.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>

#include "allocation_watch.hpp"
#include "fast_dds.hpp"
#include "rcutils/allocator.h"
#include "rmw/error_handling.h"
#include "ros_platform.hpp"
#include "sample.hpp"

namespace {

// Fixed and variable sizes, both kinds of strings, bounded and unbounded sequences, deep nesting.
// Requests and responses are messages, which services take by the same code.
constexpr const char * type_names[] = {
  "std_msgs/msg/String",
  "std_msgs/msg/Float64MultiArray",
  "std_msgs/msg/ByteMultiArray",
  "geometry_msgs/msg/PoseStamped",
  "geometry_msgs/msg/PoseArray",
  "geometry_msgs/msg/PolygonStamped",
  "sensor_msgs/msg/Image",
  "sensor_msgs/msg/Imu",
  "sensor_msgs/msg/LaserScan",
  "sensor_msgs/msg/JointState",
  "sensor_msgs/msg/CameraInfo",
  "sensor_msgs/msg/PointCloud2",
  "sensor_msgs/msg/JoyFeedbackArray",
  "nav_msgs/msg/Path",
  "nav_msgs/msg/Odometry",
  "nav_msgs/msg/OccupancyGrid",
  "diagnostic_msgs/msg/DiagnosticArray",
  "trajectory_msgs/msg/MultiDOFJointTrajectory",
  "visualization_msgs/msg/MarkerArray",
  "visualization_msgs/msg/InteractiveMarkerUpdate",
  "test_msgs/msg/Empty",
  "test_msgs/msg/BasicTypes",
  "test_msgs/msg/Strings",
  "test_msgs/msg/WStrings",
  "test_msgs/msg/Arrays",
  "test_msgs/msg/BoundedSequences",
  "test_msgs/msg/UnboundedSequences",
  "test_msgs/msg/MultiNested",
  "test_msgs/srv/Arrays_Request",
  "test_msgs/srv/BasicTypes_Request",
  "test_msgs/srv/Empty_Request",
  "rcl_interfaces/srv/SetParameters_Request",
  "rcl_interfaces/srv/SetParameters_Response",
  "rcl_interfaces/srv/DescribeParameters_Response",
};

uint64_t seed = 1;
uint64_t current = 0;  ///< number of the sample

int report_descriptor = STDERR_FILENO;
int null_descriptor = STDERR_FILENO;

void set_report_descriptor(int descriptor) {
  __sanitizer_set_report_fd(reinterpret_cast<void *>(static_cast<intptr_t>(descriptor)));
}

using Bytes = std::vector<uint8_t>;

rmw_serialized_message_t view_of(const Bytes & cdr) {
  rmw_serialized_message_t view = rmw_get_zero_initialized_serialized_message();
  view.buffer = const_cast<uint8_t *>(cdr.data());  // never written
  view.buffer_length = view.buffer_capacity = cdr.size();
  return view;
}

void require(bool holds, const char * what) {
  if (!holds) {
    throw std::runtime_error(what);
  }
}

/// Serializes into zeroed memory, because padding is not written. Fails if the message needs more
/// than `expected_bytes`. Nothing if the type support refuses: it reads sequences beyond their
/// bounds, but does not write them.
std::optional<Bytes> serialize(
  const MessageType & type, const void * message, size_t expected_bytes) {
  constexpr size_t rounding = 8;
  const size_t capacity = expected_bytes + rounding;
  rmw_serialized_message_t buffer = rmw_get_zero_initialized_serialized_message();
  const rcutils_allocator_t allocator = rcutils_get_default_allocator();
  check(rmw_serialized_message_init(&buffer, capacity, &allocator), "rmw_serialized_message_init");
  std::memset(buffer.buffer, 0, capacity);
  const rmw_ret_t code = rmw_serialize(message, type.support(), &buffer);
  rmw_reset_error();
  Bytes cdr(buffer.buffer, buffer.buffer + buffer.buffer_length);
  check(rmw_serialized_message_fini(&buffer), "rmw_serialized_message_fini");
  return code == RMW_RET_OK ? std::optional(cdr) : std::nullopt;
}

/// Bytes in memory per byte of CDR: an empty C++ string takes 32 for 4.
constexpr size_t max_factor = 16;
constexpr size_t max_constant = 4096;

/// Reason why the message is refused; nothing if it is accepted. Reads from a buffer of the exact
/// size, so that the sanitizer detects reads beyond the end.
std::optional<std::string> refusal(const MessageType & type, const Bytes & cdr, void * message) {
  const rmw_serialized_message_t view = view_of(cdr);
  allocation_watch::largest();
  const rmw_ret_t code = rmw_deserialize(&view, type.support(), message);
  const size_t largest = allocation_watch::largest();
  require(
    largest <= max_factor * cdr.size() + max_constant,
    "more memory was allocated than the message can need");
  const std::string reason = rmw_get_error_string().str;
  rmw_reset_error();
  return code == RMW_RET_OK ? std::nullopt : std::optional(reason);
}

/// Suppresses the sanitizer's warnings about allocations of Fast DDS that fail.
bool fast_dds_accepts(const FastDds & fast_dds, const MessageType & type, const Bytes & cdr) {
  const auto message = type.create();
  set_report_descriptor(null_descriptor);
  const bool accepted = fast_dds.accepts(view_of(cdr), *type.support(), message.get());
  set_report_descriptor(report_descriptor);
  return accepted;
}

/// These reasons concern bytes that no ROS 2 writer sends. XCDR version 2: Fast DDS never matches
/// such writers. A length that is too large: the type support ignores that a nested part has
/// failed, and delivers what it has. Broken UTF-16: Fast DDS leaves it to the reader.
bool is_refused_by_us_alone(const std::string & reason) {
  return reason.find("a length in it claims more bytes than are left") != std::string::npos ||
         reason.find("it is not XCDR version 1") != std::string::npos ||
         reason.find("a wide string in it is not UTF-16") != std::string::npos;
}

/// One message type in one language.
class Target {
public:
  Target(
    const Node & node, const FastDds & fast_dds, const std::string & name,
    MessageType::Language language)
  : fast_dds_(fast_dds),
    type_(name, language),
    topic_(node, (language == MessageType::Language::c ? "/c/" : "/cpp/") + name, type_) {}

  /// A valid message is unchanged after deserialization and serialization, except for trailing
  /// zeros that round up its size.
  void accept(const Bytes & cdr) const {
    const auto message = type_.create();
    require(!refusal(type_, cdr, message.get()), "a valid message is refused");
    std::optional<Bytes> again = serialize(type_, message.get(), cdr.size());
    require(again && again->size() >= cdr.size(), "a valid message becomes shorter");
    again->resize(cdr.size());
    require(*again == cdr, "a valid message becomes another");
  }
  /// For any bytes.
  void survive(const Bytes & cdr) {
    const auto message = type_.create();
    const std::optional<std::string> reason = refusal(type_, cdr, message.get());
    if (!reason) {
      serialize(type_, message.get(), cdr.size());
    }
    take(cdr, !reason);
    compare_with_fast_dds(cdr, reason);
    (reason ? refused_count : accepted_count)++;
  }

  static inline uint64_t accepted_count = 0;
  static inline uint64_t refused_count = 0;
  static inline uint64_t refused_by_us_alone_count = 0;

private:
  void take(const Bytes & cdr, bool accepted) {
    const auto message = type_.create();
    topic_.publish(cdr);
    require(topic_.take(message.get()) == accepted, "rmw_take and rmw_deserialize do not agree");
    lost_ += accepted ? 0 : 1;
    require(topic_.lost() == lost_, "a message is neither taken nor counted as lost");
  }
  void compare_with_fast_dds(const Bytes & cdr, const std::optional<std::string> & reason) const {
    const bool accepted = fast_dds_accepts(fast_dds_, type_, cdr);
    if (!reason) {
      require(accepted, "Fast DDS refuses what is accepted");
    } else if (accepted) {
      require(is_refused_by_us_alone(*reason), "Fast DDS accepts what is refused");
      ++refused_by_us_alone_count;
    }
  }

  const FastDds & fast_dds_;
  MessageType type_;
  Topic topic_;
  uint64_t lost_ = 0;
};

struct Targets {
  Targets(const Node & node, const FastDds & fast_dds, const std::string & name)
  : members(members_of(name)),
    c(node, fast_dds, name, MessageType::Language::c),
    cpp(node, fast_dds, name, MessageType::Language::cpp) {}

  const Members & members;
  Target c;
  Target cpp;
};

void run_sample(Targets & targets) {
  Random random(seed * 1'000'003 + current);
  Sample sample = make_sample(targets.members, random);
  targets.c.accept(sample.cdr);
  targets.cpp.accept(sample.cdr);
  mutate(sample, random);
  sample.cdr.shrink_to_fit();
  targets.c.survive(sample.cdr);
  targets.cpp.survive(sample.cdr);
}

void say_sample() {
  std::printf(
    "at sample %" PRIu64 " of seed %" PRIu64 ", %s\n", current, seed,
    type_names[current % std::size(type_names)]);
  std::fflush(stdout);
}

/// Silences what type supports and RMW print about refused messages, but not the sanitizers'
/// reports.
void silence() {
  report_descriptor = dup(STDERR_FILENO);
  null_descriptor = open("/dev/null", O_WRONLY);
  dup2(null_descriptor, STDERR_FILENO);
  set_report_descriptor(report_descriptor);
}

void run(uint64_t first, uint64_t samples) {
  const Node node;
  const FastDds fast_dds;
  std::vector<std::unique_ptr<Targets>> targets;
  for (const char * const name : type_names) {
    targets.push_back(std::make_unique<Targets>(node, fast_dds, name));
  }
  allocation_watch::start();
  for (current = first; current < first + samples; ++current) {
    run_sample(*targets[current % targets.size()]);
  }
}

}  // namespace

int main(int argc, char ** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: fuzz_deserialize SAMPLES [SEED [FIRST]]\n");
    return 2;
  }
  const uint64_t samples = std::strtoull(argv[1], nullptr, 10);
  seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : seed;
  silence();
  __sanitizer_set_death_callback(say_sample);
  try {
    run(argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 0, samples);
  } catch (const std::exception & error) {
    std::printf("%s\n", error.what());
    say_sample();
    return 1;
  }
  std::printf(
    "%" PRIu64 " samples of %zu types, seed %" PRIu64 ": %" PRIu64 " accepted and %" PRIu64
    " refused, %" PRIu64 " of them not by Fast DDS, by C and C++\n",
    samples, std::size(type_names), seed, Target::accepted_count, Target::refused_count,
    Target::refused_by_us_alone_count);
}
