// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How much do many publishers and subscriptions of one topic slow each other down?
//
//   matches endpoints=N iterations=N measure=create|close|depart|retire|beside|other|publish
//   depth=N
//
// With `endpoints` endpoints of each kind, one process prints how long it takes
//   create   to create one more subscription,
//   close    to close one subscription,
//   depart   to close one more publisher, whose message is not taken; closing it also sweeps the
//            publisher before, whose message it displaced,
//   retire   to close a publisher and a subscription of a topic of their own, whose message is not
//            taken; all publishers are closed first,
//   beside   to create a publisher of another topic, from a second thread, while the first creates
//            and closes all of them,
//   other    to create a publisher of another topic, with nothing beside,
//   publish  to publish; nothing is taken, so with a small depth each queue is full.
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "bench/node.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr const char * topic = "/matched";

template<typename Action>
int64_t duration_ns(Action action) {
  const int64_t start = monotonic_ns();
  action();
  return monotonic_ns() - start;
}

struct Endpoints {
  Endpoints(Node & node, size_t count, size_t depth) {
    for (size_t i = 0; i < count; ++i) {
      publishers.push_back(std::make_unique<Publisher>(node, topic, reliable_qos(depth)));
      subscriptions.push_back(std::make_unique<Subscription>(node, topic, reliable_qos(depth)));
    }
    for (const auto & publisher : publishers) {
      wait_until_matched(*publisher, count);
    }
  }
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
};

enum class Half { create, close };

std::vector<int64_t> one_more(Node & node, const Arguments & arguments, Half half) {
  const Endpoints endpoints(node, arguments.number("endpoints"), arguments.number("depth"));
  const rmw_qos_profile_t qos = reliable_qos(arguments.number("depth"));
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < arguments.number("iterations"); ++i) {
    std::unique_ptr<Subscription> subscription;
    const int64_t create_ns =
      duration_ns([&] { subscription = std::make_unique<Subscription>(node, topic, qos); });
    const int64_t close_ns = duration_ns([&] { subscription.reset(); });
    samples_ns.push_back(half == Half::create ? create_ns : close_ns);
  }
  return samples_ns;
}

void publish_from_each(const Endpoints & endpoints, const Message & message) {
  for (const auto & publisher : endpoints.publishers) {
    publisher->publish(message);
  }
}

std::vector<int64_t> depart(Node & node, const Arguments & arguments) {
  const size_t count = arguments.number("endpoints");
  const rmw_qos_profile_t qos = reliable_qos(arguments.number("depth"));
  const Endpoints endpoints(node, count, arguments.number("depth"));
  Message message;
  message.data.resize(64);
  publish_from_each(endpoints, message);
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < arguments.number("iterations"); ++i) {
    auto publisher = std::make_unique<Publisher>(node, topic, qos);
    wait_until_matched(*publisher, count);
    publisher->publish(message);
    samples_ns.push_back(duration_ns([&] { publisher.reset(); }));
  }
  return samples_ns;
}

std::vector<int64_t> retire(Node & node, const Arguments & arguments) {
  const size_t count = arguments.number("endpoints");
  const rmw_qos_profile_t qos = reliable_qos(arguments.number("depth"));
  Message message;
  message.data.resize(64);
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  for (size_t i = 0; i < count; ++i) {
    const std::string own = topic + std::to_string(i);
    publishers.push_back(std::make_unique<Publisher>(node, own.c_str(), qos));
    subscriptions.push_back(std::make_unique<Subscription>(node, own.c_str(), qos));
  }
  for (const auto & publisher : publishers) {
    wait_until_matched(*publisher, 1);
    publisher->publish(message);
  }
  std::vector<int64_t> samples_ns;
  for (auto & publisher : publishers) {
    samples_ns.push_back(duration_ns([&] { publisher.reset(); }));
  }
  for (size_t i = 0; i < count; ++i) {
    samples_ns[i] += duration_ns([&] { subscriptions[i].reset(); });
  }
  return samples_ns;
}

std::vector<int64_t> beside(Node & node, const Arguments & arguments) {
  std::vector<int64_t> samples_ns;
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!done) {
      std::unique_ptr<Publisher> publisher;
      samples_ns.push_back(duration_ns(
        [&] { publisher = std::make_unique<Publisher>(node, "/other", reliable_qos(1)); }));
    }
  });
  { const Endpoints endpoints(node, arguments.number("endpoints"), arguments.number("depth")); }
  done = true;
  other.join();
  return samples_ns;
}

std::vector<int64_t> other(Node & node, const Arguments & arguments) {
  const Endpoints endpoints(node, arguments.number("endpoints"), arguments.number("depth"));
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < arguments.number("iterations"); ++i) {
    std::unique_ptr<Publisher> publisher;
    samples_ns.push_back(duration_ns(
      [&] { publisher = std::make_unique<Publisher>(node, "/other", reliable_qos(1)); }));
  }
  return samples_ns;
}

std::vector<int64_t> publish(Node & node, const Arguments & arguments) {
  const size_t depth = arguments.number("depth");
  const Endpoints endpoints(node, arguments.number("endpoints"), depth);
  Message message;
  message.data.resize(64);
  Publisher & last = *endpoints.publishers.back();
  publish_from_each(endpoints, message);  // with a depth of 1, the first one fills each queue
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < arguments.number("iterations"); ++i) {
    samples_ns.push_back(duration_ns([&] { last.publish(message); }));
  }
  return samples_ns;
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    Node node("matches");
    const std::string & measure = arguments.text("measure");
    print_samples(
      measure == "create"   ? one_more(node, arguments, Half::create)
      : measure == "close"  ? one_more(node, arguments, Half::close)
      : measure == "depart" ? depart(node, arguments)
      : measure == "retire" ? retire(node, arguments)
      : measure == "beside" ? beside(node, arguments)
      : measure == "other"  ? other(node, arguments)
                            : publish(node, arguments));
  });
}
