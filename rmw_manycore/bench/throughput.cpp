// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How many messages per second arrive without loss, with a bounded number in flight?
//
//   throughput role=sink
//   throughput role=source bytes=N in_flight=N warm_up=N stretch=N stretches=N
//
// The source sends a message as soon as the one `in_flight` earlier is acknowledged. The sink
// acknowledges each message with its number and the number of messages missing so far. The samples
// are the durations of stretches of `stretch` messages, from acknowledgement to acknowledgement.
#include "bench/node.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

// Twice the default number in flight, so that no history drops a message.
constexpr size_t depth = 16;

class Source {
public:
  Source(size_t bytes, size_t in_flight) : in_flight_(in_flight) { message_.data.resize(bytes); }

  void connect() {
    wait_until_matched(publisher_, acknowledgements_);
    set_number(message_, 0);
    do {
      publisher_.publish(message_);
    } while (!wait_set_.wait(acknowledgements_, std::chrono::milliseconds(100)));
  }

  /// Sends `count` messages. On return all but the last `in_flight` - 1 are acknowledged.
  void send(size_t count) {
    for (size_t i = 0; i < count; ++i) {
      set_number(message_, ++sent_);
      publisher_.publish(message_);
      wait_for_acknowledgement_of(sent_ < in_flight_ ? 0 : sent_ - in_flight_ + 1);
    }
  }

  void drain() { wait_for_acknowledgement_of(sent_); }

  void stop() { stop_subscribers(publisher_); }
  uint64_t lost() const { return lost_; }

private:
  void wait_for_acknowledgement_of(uint64_t number) {
    while (acknowledged_ < number) {
      take_next(wait_set_, acknowledgements_, acknowledgement_);
      acknowledged_ = number_of(acknowledgement_);
      lost_ = acknowledgement_.layout.data_offset;
    }
  }

  const size_t in_flight_;
  Node node_{"source"};
  Publisher publisher_{node_, "/data", reliable_qos(depth)};
  Subscription acknowledgements_{node_, "/acknowledgement", reliable_qos(depth)};
  WaitSet wait_set_{node_};
  Message message_;
  Message acknowledgement_;
  uint64_t sent_ = 0;
  uint64_t acknowledged_ = 0;
  uint64_t lost_ = 0;
};

void source(const Arguments & arguments) {
  Source source(arguments.number("bytes"), arguments.number("in_flight"));
  source.connect();
  source.send(arguments.number("warm_up"));
  std::vector<int64_t> samples_ns(arguments.number("stretches"));
  for (int64_t & sample_ns : samples_ns) {
    const int64_t start_ns = monotonic_ns();
    source.send(arguments.number("stretch"));
    sample_ns = monotonic_ns() - start_ns;
  }
  source.drain();
  source.stop();
  print_samples(samples_ns, {{"lost", source.lost()}});
}

void sink() {
  Node node("sink");
  Publisher publisher(node, "/acknowledgement", reliable_qos(depth));
  Subscription subscription(node, "/data", reliable_qos(depth));
  WaitSet wait_set(node);
  Message message;
  Message acknowledgement;
  acknowledgement.data.resize(min_message_bytes);
  uint64_t previous = 0;
  while (true) {
    take_next(wait_set, subscription, message);
    if (message.data.empty()) {
      return;
    }
    const uint64_t number = number_of(message);
    if (number > previous + 1) {
      acknowledgement.layout.data_offset += static_cast<uint32_t>(number - previous - 1);
    }
    previous = number;
    set_number(acknowledgement, number);
    publisher.publish(acknowledgement);
  }
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    arguments.text("role") == "source" ? source(arguments) : sink();
  });
}
