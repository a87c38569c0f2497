// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "node_role.hpp"

#include <unistd.h>

#include <map>
#include <sstream>

#include "messages.hpp"
#include "platform/clock.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

Qos qos_of(const std::string & word) {
  if (word == "keep_all") {
    return keep_all();
  }
  const auto depth = static_cast<uint32_t>(std::stoul(word));
  constexpr int64_t hour_ns = 3600 * ns_per_s;
  if (word.find("+deadline") != std::string::npos) {
    Qos qos = keep_last(depth);
    qos.deadline_ns = hour_ns;
    return qos;
  }
  if (word.find("+lease") != std::string::npos) {
    Qos qos = keep_last(depth);
    qos.liveliness_lease_ns = hour_ns;
    return qos;
  }
  if (word.find("+transient_local") != std::string::npos) {
    return transient_local(depth);
  }
  return word.find("+best_effort") != std::string::npos ? best_effort(depth) : keep_last(depth);
}

WaitMode mode_of(const std::string & word) {
  return word == "spin"       ? WaitMode::spin
         : word == "adaptive" ? WaitMode::adaptive
                              : WaitMode::block;
}

Placement placement_of(const Arguments & arguments) {
  Placement placement;
  placement.platform = arguments.at(0);
  placement.cluster = static_cast<uint32_t>(std::stoul(arguments.at(1)));
  placement.wait_mode = mode_of(arguments.at(2));
  placement.label = "node";
  return placement;
}

class Puppet {
public:
  explicit Puppet(const Arguments & arguments) : process_(Process::join(placement_of(arguments))) {}

  /// Returns the answer; empty for a command that ends the node.
  std::string obey(const std::string & line) {
    std::istringstream words(line);
    std::string command;
    words >> command;
    return commands_.at(command)(words);
  }

private:
  using Words = std::istringstream;

  static std::string word(Words & words) {
    std::string next;
    words >> next;
    return next;
  }
  static uint64_t number(Words & words) { return std::stoull(word(words)); }

  EndpointSpec spec(Words & words) {
    const std::string topic = word(words);
    return on_topic(topic, qos_of(word(words)));
  }

  void publish_range(uint64_t first, uint64_t last, size_t size_bytes) {
    for (uint64_t i = first; i <= last; ++i) {
      publish(*publisher_, i, size_bytes, static_cast<uint64_t>(getpid()));
    }
  }

  /// Waits for the next message of `writer`, skipping others.
  uint64_t next_of(uint64_t writer) {
    while (true) {
      const Payload payload = take_next(*process_, *subscription_);
      if (payload.writer == writer) {
        return payload.number;
      }
    }
  }

  void take_exactly(uint64_t first, uint64_t last, uint64_t writer) {
    for (uint64_t i = first; i <= last; ++i) {
      const uint64_t found = next_of(writer);
      if (found != i) {
        throw std::runtime_error(
          "expected message " + std::to_string(i) + ", found " + std::to_string(found));
      }
    }
  }

  uint64_t take_ordered(uint64_t last, uint64_t writer) {
    uint64_t count = 0;
    for (uint64_t before = 0; before < last; ++count) {
      const uint64_t found = next_of(writer);
      if (found <= before) {
        throw std::runtime_error("wrong order");
      }
      before = found;
    }
    return count;
  }

  std::string claim() {
    const uint64_t found = next_claim();
    return std::to_string(found);
  }

  uint64_t next_claim() {
    wait_until("a message to claim", [&] {
      std::optional<Claim> next = subscription_->claim();
      if (next) {
        claim_ = std::make_unique<Claim>(std::move(*next));
      }
      return claim_ != nullptr;
    });
    return Payload::read(claim_->data(), claim_->size()).number;
  }

  std::shared_ptr<Process> process_;
  std::unique_ptr<Publisher> publisher_;
  std::unique_ptr<Subscription> subscription_;
  std::unique_ptr<Claim> claim_;
  std::unique_ptr<NoDescriptors> no_descriptors_;

  const std::map<std::string, std::function<std::string(Words &)>> commands_{
    {"publisher",
     [this](Words & words) {
       publisher_ = process_->create_publisher(spec(words));
       return "ok";
     }},
    {"subscription",
     [this](Words & words) {
       subscription_ = process_->create_subscription(spec(words));
       return "ok";
     }},
    {"matched",
     [this](Words & words) {
       const uint64_t count = number(words);
       wait_until("matches", [&] {
         return (publisher_ ? publisher_->matched() : subscription_->matched()).current == count;
       });
       return "ok";
     }},
    {"publish",
     [this](Words & words) {
       const uint64_t first = number(words);
       const uint64_t last = number(words);
       publish_range(first, last, number(words));
       return "ok";
     }},
    {"publish_endlessly",
     [this](Words & words) {
       publish_range(1, UINT64_MAX - 1, number(words));
       return "";
     }},
    {"take",
     [this](Words & words) {
       const uint64_t first = number(words);
       const uint64_t last = number(words);
       take_exactly(first, last, number(words));
       return "ok";
     }},
    {"take_ordered",
     [this](Words & words) {
       const uint64_t last = number(words);
       return std::to_string(take_ordered(last, number(words)));
     }},
    {"take_all",
     [this](Words &) {
       ::take_all(*subscription_);
       return "ok";
     }},
    {"look",
     [this](Words &) {
       wait_until("a hint", [&] { return subscription_->has_data(); });
       const std::optional<Payload> found = ::take(*subscription_);
       return found ? std::to_string(found->number) : "nothing";
     }},
    {"claim", [this](Words &) { return claim(); }},
    {"release",
     [this](Words &) {
       Payload::read(claim_->data(), claim_->size());
       claim_.reset();
       return "ok";
     }},
    {"close",
     [this](Words &) {
       publisher_.reset();
       subscription_.reset();
       return "ok";
     }},
    {"use_up_descriptors",
     [this](Words &) {
       wait_until("its receive thread is watched", [] { return has_pidfds(getpid()); });
       no_descriptors_ = std::make_unique<NoDescriptors>();
       return "ok";
     }},
    {"free_descriptors",
     [this](Words &) {
       no_descriptors_.reset();
       return "ok";
     }},
    {"begin_context",
     [this](Words &) {
       process_->begin_context();
       return "ok";
     }},
    {"end_context",
     [this](Words &) {
       process_->end_context();
       return "ok";
     }},
    {"leave", [](Words &) { return ""; }},
  };
};

const Role node("node", [](Lines & test, const Arguments & arguments) {
  Puppet puppet(arguments);
  test.say("joined");
  for (std::string answer = puppet.obey(test.hear()); answer != "";
       answer = puppet.obey(test.hear())) {
    test.say(answer);
  }
});

}  // namespace

void join_and_stay(Lines & test, const std::string & platform) {
  const auto process = join_platform(platform);
  test.say("joined");
  test.hear();
}
