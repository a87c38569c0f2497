// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How long is the registry lock held at a time if a topic has many publishers and subscriptions?
//
//   registry_holds endpoints=N changes=N cpu=N
//
// Prints the longest hold of each operation in nanoseconds, and as OPERATION_p99 its 99th
// percentile:
//   control               nothing: arithmetic for 50 us, without a lock, 10,000 times. A virtual
//                         machine's host runs others meanwhile, and that counts as CPU time here
//   create                all endpoints of the topic, each matched with the earlier ones
//   repair                by the owner after one that was killed, of all these endpoints
//   close_subscription    `changes` subscriptions that have taken nothing
//   close_publisher       `changes` publishers, each leaving a message that is not taken
//   close_deep            a publisher whose last 1,000 messages N subscriptions have not taken
//   close_server          a server with 1,000 replies to one of N clients
//   free_large            a publisher whose topic DSM has grown to more than 16 MiB
//   create_queue          a subscription of depth 65,535
//   free_queue            closing it, and freeing its queue
//   reap                  a killed process with `changes` endpoints of each kind, and such a
//   publisher
// A thread on CPU `cpu` watches the word that is odd while the lock is held, and reads the CPU
// clock of the holder: time in which the kernel runs other threads does not count, nor do holds of
// unrelated processes. An operation without an observed hold, because the watching thread got no
// CPU, is omitted.
#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "bench/peer.hpp"
#include "bench/program.hpp"
#include "platform/clock.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/matching/sweeping.hpp"
#include "transport/process.hpp"
#include "transport/registry/registry.hpp"

namespace {

using namespace manycore;

clockid_t clock_of_this_thread() {
  clockid_t clock{};
  pthread_getcpuclockid(pthread_self(), &clock);
  return clock;
}

/// Measures the CPU time of the thread that creates it during each of its holds of the registry
/// lock.
class HoldWatch {
public:
  HoldWatch(const RegistryHeader & header, size_t cpu) : header_(header) {
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

  /// Durations in ns of the holds since the last call.
  std::vector<uint64_t> take_holds_ns() {
    const std::lock_guard<std::mutex> guard(mutex_);
    return std::exchange(holds_ns_, {});
  }

private:
  bool is_owned_by_the_thread() const {
    const std::optional<uint32_t> seat = header_.mutex.owner();
    return seat && *seat < lock_seat_count && header_.seats[*seat].occupied.owner() == thread_id_;
  }

  /// Measures until the last load that found the lock held.
  void watch_one_hold() {
    const uint64_t seen = header_.changes.load();
    if (seen % 2 == 0) {
      return;
    }
    const int64_t start_ns = clock_ns(clock_);
    const auto is_held = [&] {  // `changes` is odd without an owner before a repair
      return header_.changes.load() == seen && is_owned_by_the_thread() && !done_;
    };
    if (!is_held()) {
      return;
    }
    int64_t end_ns = start_ns;
    for (int64_t ran_ns = start_ns; is_held(); ran_ns = clock_ns(clock_)) {
      end_ns = ran_ns;
    }
    const std::lock_guard<std::mutex> guard(mutex_);
    holds_ns_.push_back(static_cast<uint64_t>(end_ns - start_ns));
  }

  const RegistryHeader & header_;
  const pid_t thread_id_ = gettid();
  const clockid_t clock_ = clock_of_this_thread();
  std::mutex mutex_;
  std::vector<uint64_t> holds_ns_;
  std::atomic<bool> watching_{false};
  std::atomic<bool> done_{false};
  std::thread thread_;
};

void report(std::vector<uint64_t> holds_ns, const std::string & operation, bench::Counts & found) {
  if (holds_ns.empty()) {
    return;  // the watching thread got no CPU
  }
  std::sort(holds_ns.begin(), holds_ns.end());
  found[operation] = holds_ns.back();
  found[operation + "_p99"] = holds_ns[(holds_ns.size() - 1) * 99 / 100];
}

/// Returns how long so many steps of arithmetic take, ns.
uint64_t time_of(uint64_t steps) {
  const clockid_t clock = clock_of_this_thread();
  const int64_t start_ns = clock_ns(clock);
  volatile double sum = 1;
  for (uint64_t i = 0; i < steps; ++i) {
    sum = sum * 1.0000001;
  }
  return static_cast<uint64_t>(clock_ns(clock) - start_ns);
}

void report_control(bench::Counts & found) {
  constexpr uint64_t loop_ns = 50'000;
  constexpr uint64_t many = 1'000'000;
  const uint64_t steps = many * loop_ns / time_of(many);
  std::vector<uint64_t> times_ns(10'000);
  std::generate(times_ns.begin(), times_ns.end(), [=] { return time_of(steps); });
  report(std::move(times_ns), "control", found);
}

EndpointSpec spec_of(Process & process) {
  EndpointSpec spec;
  spec.node = process.add_node("bench", "/", "/");
  spec.topic = "/held";
  spec.type = "std_msgs/msg/String";
  spec.qos.depth = 1;
  return spec;
}

void publish(Publisher & publisher, size_t bytes = 64) {
  publisher.publish(publisher.draft(bytes), bytes, realtime_ns());
}

constexpr uint32_t deep = 1000;

/// A publisher with many readers, which holds `deep` messages. All replies are for the last reader.
struct DeepHistory {
  DeepHistory(Process & process, EndpointSpec spec, EndpointRole role, size_t readers) {
    spec.topic = "/deep";
    spec.role = role;
    for (size_t i = 0; i < readers; ++i) {
      spec.qos.depth = role == EndpointRole::reply && i + 1 != readers ? 1 : deep;
      subscriptions.push_back(process.create_subscription(spec));
    }
    publisher = process.create_publisher(spec);
    for (uint32_t i = 0; i < deep; ++i) {
      publisher->publish(publisher->draft(64), 64, realtime_ns(), {subscriptions.back()->gid(), i});
    }
  }
  std::vector<std::unique_ptr<Subscription>> subscriptions;
  std::unique_ptr<Publisher> publisher;
};

constexpr size_t large_bytes = 16 << 20;

/// Returns a publisher whose one large message no subscription wants.
std::unique_ptr<Publisher> large_publisher(Process & process, EndpointSpec spec) {
  spec.topic = "/large";
  std::unique_ptr<Publisher> publisher = process.create_publisher(spec);
  publish(*publisher, large_bytes);
  return publisher;
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

/// A process with endpoints of the topic, which is killed once it is ready.
class Victim {
public:
  explicit Victim(size_t count) : child_(fork()) {
    if (child_ == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      raise(SIGSTOP);
      const auto process = Process::join(Placement::from_environment());
      Endpoints endpoints;
      const EndpointSpec spec = spec_of(*process);
      for (size_t i = 0; i < count; ++i) {
        endpoints.add_one(*process, spec);
      }
      endpoints.publish_all();
      const auto large = large_publisher(*process, spec);
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

/// Stops the receive thread while it does not hold the registry lock. This process then reaps in
/// its place, because the kernel updates the CPU clock of another process only at timer ticks.
class Standstill {
public:
  explicit Standstill(Registry & registry)
  : pid_(registry.clusters().at(1).header().receive_thread_pid) {
    const Registry::Lock lock(registry);
    ::kill(pid_, SIGSTOP);
    while (state() != 'T') {
      std::this_thread::yield();
    }
  }
  ~Standstill() { ::kill(pid_, SIGCONT); }
  Standstill(const Standstill &) = delete;
  Standstill & operator=(const Standstill &) = delete;

private:
  char state() const {
    std::ifstream file("/proc/" + std::to_string(pid_) + "/stat");
    std::string skipped;
    char state = 0;
    file >> skipped >> skipped >> state;
    return state;
  }

  pid_t pid_;
};

/// Maps the platform's memory anew, as a receive thread does, then reaps.
void reap(const PlatformPaths & paths) {
  Registry registry(paths);
  if (reap_dead(registry, 1) != 1) {
    throw std::runtime_error("the killed process is not found dead");
  }
  sweeping::sweep_all(registry);
}

/// What the operations on one process's endpoints are measured with.
struct Measurement {
  void report(const std::string & operation) { ::report(holds.take_holds_ns(), operation, found); }
  Process & process;
  const EndpointSpec spec;
  HoldWatch & holds;
  bench::Counts & found;
};

/// Creates a topic of many endpoints, and closes some of them.
void measure_changes(Measurement & on, Endpoints & endpoints, size_t count, size_t changes) {
  Registry registry(PlatformPaths::of(on.process.placement().platform));
  for (size_t i = 0; i < count; ++i) {
    endpoints.add_one(on.process, on.spec);
  }
  on.report("create");
  registry.header().needs_repair = 1;  // as if the owner of the lock had been killed
  { const Registry::Lock lock(registry); }
  on.process.add_node("next", "/", "/");  // once its hold is seen, that of the repair is noted
  on.report("repair");
  endpoints.publish_all();
  endpoints.subscriptions.resize(endpoints.subscriptions.size() - changes);
  on.report("close_subscription");
  endpoints.publishers.resize(endpoints.publishers.size() - changes);
  on.report("close_publisher");
}

void measure_deep_histories(Measurement & on, size_t readers) {
  for (const EndpointRole role : {EndpointRole::topic, EndpointRole::reply}) {
    DeepHistory history(on.process, on.spec, role, readers);
    on.holds.take_holds_ns();
    history.publisher.reset();
    on.report(role == EndpointRole::reply ? "close_server" : "close_deep");
  }
}

/// Much memory at once: a grown topic DSM, and the queue of a subscription.
void measure_memory(Measurement & on) {
  auto large = large_publisher(on.process, on.spec);
  on.holds.take_holds_ns();
  large.reset();
  on.report("free_large");
  EndpointSpec deepest = on.spec;
  deepest.topic = "/deepest";
  deepest.qos.depth = UINT16_MAX;
  auto subscription = on.process.create_subscription(deepest);
  on.report("create_queue");
  subscription.reset();
  on.report("free_queue");
}

void run(const bench::Arguments & arguments) {
  const size_t changes = arguments.number("changes");
  const size_t count = arguments.number("endpoints");
  Victim victim(changes);
  const auto process = Process::join(Placement::from_environment());
  const EndpointSpec spec = spec_of(*process);
  Registry registry(PlatformPaths::of(process->placement().platform));
  HoldWatch holds(registry.header(), arguments.number("cpu"));
  bench::Counts found;
  Measurement on{*process, spec, holds, found};
  report_control(found);
  Endpoints endpoints;
  measure_changes(on, endpoints, count, changes);
  measure_deep_histories(on, count);
  measure_memory(on);
  victim.join_platform();
  {
    const Standstill receive_thread(registry);
    holds.take_holds_ns();
    victim.kill();
    reap(registry.paths());
  }
  on.report("reap");
  bench::print_samples({}, found);
  std::fflush(stdout);
  _exit(EXIT_SUCCESS);  // closing all endpoints is not part of the measurement
}

}  // namespace

int main(int argc, char ** argv) { return bench::run_program(argc, argv, run); }
