// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Measures what each of many publishers costs a subscription.
//
//   sources publishers=N iterations=N news=0|1
//
// Prints how long a subscription takes to resync with all its publishers, as it does once hints may
// be missing. With `news`, each publisher has published a message since the last resync. Also
// prints, as `match_bytes`, the SMEM that the matches of as many publishers and subscriptions take,
// once each publisher has published.
#include <memory>
#include <vector>

#include "bench/program.hpp"
#include "platform/clock.hpp"
#include "transport/layout/subscription_layout.hpp"
#include "transport/process.hpp"
#include "transport/registry/registry.hpp"

namespace {

using namespace manycore;

class Topic {
public:
  Topic(Process & process, const std::string & name, size_t depth) : process_(process) {
    spec_.node = process.add_node("bench", "/", "/");
    spec_.topic = name;
    spec_.type = "std_msgs/msg/String";
    spec_.qos.depth = static_cast<uint32_t>(depth);
  }
  std::unique_ptr<Subscription> subscription() { return process_.create_subscription(spec_); }
  std::vector<std::unique_ptr<Subscription>> subscriptions(size_t count) {
    std::vector<std::unique_ptr<Subscription>> all;
    for (size_t i = 0; i < count; ++i) {
      all.push_back(subscription());
    }
    return all;
  }
  std::vector<std::unique_ptr<Publisher>> publishers(size_t count) {
    std::vector<std::unique_ptr<Publisher>> all;
    for (size_t i = 0; i < count; ++i) {
      all.push_back(process_.create_publisher(spec_));
    }
    return all;
  }

private:
  Process & process_;
  EndpointSpec spec_;
};

void publish(Publisher & publisher) {
  constexpr size_t bytes = 64;
  publisher.publish(publisher.draft(bytes), bytes, realtime_ns());
}

uint64_t match_bytes(Process & process, const Cluster & cluster, size_t count) {
  const auto used_with = [&](const std::string & published, const std::string & subscribed) {
    const auto publishers = Topic(process, published, 1).publishers(count);
    const auto subscriptions = Topic(process, subscribed, 1).subscriptions(count);
    for (const auto & publisher : publishers) {
      publish(*publisher);  // gives each reader a seat
    }
    return cluster.used_bytes();
  };
  const uint64_t apart = used_with("/one", "/other");
  return used_with("/both", "/both") - apart;
}

std::vector<int64_t> resyncs(Process & process, Registry & registry, const bench::Arguments & all) {
  const size_t count = all.number("publishers");
  Topic topic(process, "/looked_into", count);
  const auto publishers = topic.publishers(count);
  const auto subscription = topic.subscription();
  const auto slot = static_cast<uint32_t>(endpoint_in(subscription->gid()));
  auto & header = *registry.clusters().find<SubscriptionHeader>(registry.endpoints()[slot].block);
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < all.number("iterations"); ++i) {
    for (const auto & publisher : publishers) {
      if (all.number("news") != 0) {
        publish(*publisher);
      }
    }
    header.resync.store(1);
    const int64_t start_ns = monotonic_ns();
    subscription->arrivals();
    samples_ns.push_back(monotonic_ns() - start_ns);
    while (subscription->claim()) {
    }
  }
  return samples_ns;
}

void run(const bench::Arguments & arguments) {
  const auto process = Process::join(Placement::from_environment());
  Registry registry(PlatformPaths::of(process->placement().platform));
  const uint64_t bytes =
    match_bytes(*process, registry.clusters().at(1), arguments.number("publishers"));
  bench::print_samples(resyncs(*process, registry, arguments), {{"match_bytes", bytes}});
}

}  // namespace

int main(int argc, char ** argv) { return manycore::bench::run_program(argc, argv, run); }
