// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long is the registry lock held at a time, when a topic has many publishers and subscriptions?
//
//   registry_holds endpoints=N changes=N cpu=N
//
// Prints the longest hold in nanoseconds of each operation, and as OPERATION_p99 what 99 % of its
// holds do not exceed:
//   create                all endpoints of the topic, each matched with those before it
//   close_subscription    `changes` subscriptions that have taken nothing
//   close_publisher       `changes` publishers, each of which leaves a message that none has taken
//   sweep                 freeing what these left, once newer messages have displaced theirs
//   reap                  a killed process with `changes` of both kinds
// A thread on the CPU `cpu` watches the word that is odd while the lock is held, and reads the CPU
// clock of the holder: that the kernel lets others run meanwhile does not count, nor do holds of
// processes that are about something else. An operation of which it saw no hold, as it got no CPU
// itself, is left out.
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"
#include "transport/process.hpp"
#include "transport/registry/registry.hpp"

namespace {

using namespace manycore;

/// A process whose holds count, and the clock they are measured by.
struct alignas(uint64_t) Holder {  // clang calls a library for an atomic of less alignment
  pid_t process;
  clockid_t clock;
};

Holder this_thread() {
  clockid_t clock{};
  pthread_getcpuclockid(pthread_self(), &clock);
  return {getpid(), clock};
}

Holder process_of(pid_t pid) {
  clockid_t clock{};
  if (clock_getcpuclockid(pid, &clock) != 0) {
    throw std::runtime_error("the receive thread has no CPU clock");
  }
  return {pid, clock};
}

/// How long a holder of the registry lock ran, in nanoseconds.
class HoldWatch {
public:
  HoldWatch(const RegistryHeader & header, size_t cpu) : header_(header), holder_(this_thread()) {
    thread_ = std::thread([this, cpu] {
      bench::pin_to(cpu);
      for (watching_ = true; !done_;) {
        watch_one_hold();
      }
    });
    while (!watching_) {
    }
  }
  ~HoldWatch() {
    done_ = true;
    thread_.join();
  }
  HoldWatch(const HoldWatch &) = delete;
  HoldWatch & operator=(const HoldWatch &) = delete;

  void follow(Holder holder) { holder_ = holder; }
  /// Those since the last call.
  std::vector<uint64_t> take_holds_ns() {
    const std::lock_guard<std::mutex> guard(mutex_);
    return std::exchange(holds_ns_, {});
  }

private:
  bool is_thread_of(pid_t process, pid_t thread) {
    const auto [known, is_new] = threads_.try_emplace({process, thread}, false);
    if (is_new) {
      const std::string task =
        "/proc/" + std::to_string(process) + "/task/" + std::to_string(thread);
      known->second = access(task.c_str(), F_OK) == 0;
    }
    return known->second;
  }
  /// Up to the last look at which it was held.
  void watch_one_hold() {
    const uint64_t seen = header_.changes.load();
    if (seen % 2 == 0) {
      return;
    }
    const Holder holder = holder_;
    const int64_t start_ns = clock_ns(holder.clock);
    const bool counts = is_thread_of(holder.process, header_.mutex.owner());
    int64_t end_ns = start_ns;
    for (int64_t ran_ns = start_ns; header_.changes.load() == seen && !done_;
         ran_ns = clock_ns(holder.clock)) {
      end_ns = ran_ns;
    }
    if (counts) {
      const std::lock_guard<std::mutex> guard(mutex_);
      holds_ns_.push_back(static_cast<uint64_t>(end_ns - start_ns));
    }
  }

  const RegistryHeader & header_;
  std::atomic<Holder> holder_;
  std::map<std::pair<pid_t, pid_t>, bool> threads_;  ///< by process and thread
  std::mutex mutex_;
  std::vector<uint64_t> holds_ns_;
  std::atomic<bool> watching_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

void report(HoldWatch & holds, const std::string & operation, bench::Counts & found) {
  std::vector<uint64_t> holds_ns = holds.take_holds_ns();
  if (holds_ns.empty()) {
    return;  // what watches got no CPU
  }
  std::sort(holds_ns.begin(), holds_ns.end());
  found[operation] = holds_ns.back();
  found[operation + "_p99"] = holds_ns[(holds_ns.size() - 1) * 99 / 100];
}

EndpointSpec spec_of(Process & process) {
  EndpointSpec spec;
  spec.node = process.add_node("bench", "/", "/");
  spec.topic = "/held";
  spec.type = "std_msgs/msg/String";
  spec.qos.depth = 1;
  return spec;
}

void publish(Publisher & publisher) {
  constexpr size_t bytes = 64;
  publisher.publish(publisher.draft(bytes), bytes, realtime_ns());
}

struct Endpoints {
  void add_one(Process & process, const EndpointSpec & spec) {
    publishers.push_back(process.create_publisher(spec));
    subscriptions.push_back(process.create_subscription(spec));
  }
  void publish_all() {
    for (const auto & publisher : publishers) {
      publish(*publisher);
    }
  }
  std::vector<std::unique_ptr<Publisher>> publishers;
  std::vector<std::unique_ptr<Subscription>> subscriptions;
};

/// A process with endpoints of the topic, to be killed once it is ready.
class Victim {
public:
  explicit Victim(size_t count) : child_(fork()) {
    if (child_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      raise(SIGSTOP);
      const auto process = Process::join(Placement::from_environment(0));
      Endpoints endpoints;
      const EndpointSpec spec = spec_of(*process);
      for (size_t i = 0; i < count; ++i) {
        endpoints.add_one(*process, spec);
      }
      endpoints.publish_all();
      raise(SIGSTOP);
      _exit(EXIT_SUCCESS);
    }
    wait_until_stopped();
  }
  ~Victim() { kill(); }
  Victim(const Victim &) = delete;
  Victim & operator=(const Victim &) = delete;

  void join_platform() {
    ::kill(child_, SIGCONT);
    wait_until_stopped();
  }
  void kill() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      waitpid(std::exchange(child_, 0), nullptr, 0);
    }
  }

private:
  void wait_until_stopped() const {
    int status = 0;
    if (waitpid(child_, &status, WUNTRACED) != child_ || !WIFSTOPPED(status)) {
      throw std::runtime_error("a process of the bench ended early");
    }
  }

  pid_t child_;
};

void wait_until_alone(Registry & registry) {
  const int64_t deadline_ns = monotonic_ns() + 20'000'000'000;
  const auto live = [&] {
    uint32_t count = 0;
    for (uint32_t slot = 0; slot < registry.processes().high_water(); ++slot) {
      count += registry.processes().is_live(slot) ? 1 : 0;
    }
    return count;
  };
  while (live() > 1) {
    if (monotonic_ns() > deadline_ns) {
      throw std::runtime_error("a killed process stays in the registry");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void run(const bench::Arguments & arguments) {
  const size_t changes = arguments.number("changes");
  Victim victim(changes);
  const auto process = Process::join(Placement::from_environment(0));
  const EndpointSpec spec = spec_of(*process);
  Registry registry(PlatformPaths::of(process->placement().platform));
  HoldWatch holds(registry.header(), arguments.number("cpu"));
  bench::Counts found;
  Endpoints endpoints;
  for (size_t i = 0; i < arguments.number("endpoints"); ++i) {
    endpoints.add_one(*process, spec);
  }
  report(holds, "create", found);
  endpoints.publish_all();
  endpoints.subscriptions.resize(endpoints.subscriptions.size() - changes);
  report(holds, "close_subscription", found);
  endpoints.publishers.resize(endpoints.publishers.size() - changes);
  report(holds, "close_publisher", found);
  endpoints.publish_all();
  EndpointSpec other = spec;
  other.topic = "/other";
  for (size_t i = 0; i < changes; ++i) {
    process->create_publisher(other);
  }
  report(holds, "sweep", found);
  victim.join_platform();
  holds.follow(process_of(registry.clusters().at(1).header().receive_thread_pid));
  holds.take_holds_ns();
  victim.kill();
  wait_until_alone(registry);
  report(holds, "reap", found);
  bench::print_samples({}, found);
  std::fflush(stdout);
  _exit(EXIT_SUCCESS);  // closing them all is no part of the question
}

}  // namespace

int main(int argc, char ** argv) { return bench::run_program(argc, argv, run); }
