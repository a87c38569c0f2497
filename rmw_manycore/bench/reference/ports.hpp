// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bench/rcl_node.hpp"
#include "bench/reference/message.hpp"

namespace manycore::bench::reference {

/// Parameters of inputs and outputs.
struct PortOptions {
  MessageType type;
  bool is_checked;  // write and verify the payload
  size_t depth;     // 0 = keep all
};

/// A message in this process's private memory.
class OwnMessage {
public:
  explicit OwnMessage(size_t bytes) : words_((bytes + 7) / 8) {}
  Message & get() { return *reinterpret_cast<Message *>(words_.data()); }

private:
  std::vector<uint64_t> words_;
};

/// A subscription with the last message received. missed() counts gaps among the messages that the
/// node processes; reported losses count gaps among all messages.
class Input {
public:
  Input(RclNode & node, std::string topic, const PortOptions & options);

  const rcl_subscription_t & subscription() const { return subscription_; }
  /// False if there was no message.
  bool take();
  const Message & message() { return message_.get(); }
  uint32_t missed() { return processed_.before(sequence_of(message_.get())); }
  /// Prints the number of lost messages, unless there are none.
  void say_losses();

  bool is_cached = false;

private:
  std::string topic_;
  PortOptions options_;
  OwnMessage message_;
  rcl_subscription_t & subscription_;
  Gaps received_;
  Gaps processed_;
  uint64_t lost_ = 0;
  uint64_t said_ns_ = 0;
};

/// A publisher that uses loaned messages if the middleware supports them.
class Output {
public:
  Output(
    RclNode & node, std::string node_name, const std::string & topic, const PortOptions & options);

  /// Publishes the records of all sources, followed by a record of this node.
  void publish(
    uint64_t timestamp_ns, const std::vector<Input *> & sources = {}, int64_t result = 0);

private:
  void fill(
    Message & message, uint64_t timestamp_ns, const std::vector<Input *> & sources, int64_t result);
  template<typename Publish>
  void until_published(Publish publish);

  std::string node_name_;
  PortOptions options_;
  rcl_publisher_t & publisher_;
  const bool lends_;
  OwnMessage own_;
  uint32_t sequence_ = 0;
};

}  // namespace manycore::bench::reference
