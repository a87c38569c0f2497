// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/process.hpp"

#include <unistd.h>

#include <atomic>
#include <map>
#include <mutex>

#include "platform/cpu.hpp"
#include "platform/error.hpp"
#include "transport/lifecycle/lifecycle.hpp"
#include "transport/lifecycle/receive_thread_watcher.hpp"
#include "transport/lifecycle/slot_and_line.hpp"
#include "transport/lifecycle/trace_control.hpp"
#include "transport/matching/joining.hpp"
#include "transport/matching/leaving.hpp"
#include "transport/new_endpoint.hpp"
#include "transport/publisher/publisher_impl.hpp"
#include "transport/qos/qos_ranges.hpp"
#include "transport/registry/block_in_hand.hpp"
#include "transport/registry/membership.hpp"
#include "transport/registry/smem_charge.hpp"
#include "transport/subscription/subscription_block.hpp"
#include "transport/subscription/subscription_impl.hpp"
#include "transport/transfer/transfer.hpp"
#include "virtual_time/door.hpp"

namespace manycore {
namespace {

/// The join lock makes it one creator at a time; making the files takes too long for the registry
/// lock.
void ensure_cluster(Registry & registry, uint32_t id) {
  RegistryHeader & header = registry.header();
  const uint64_t bit = uint64_t{1} << (id - 1);
  if ((header.clusters_present.load() & bit) != 0) {
    registry.clusters().at(id);
    return;
  }
  // Left by a creator that died before it set the bit.
  unlink(registry.paths().cluster(id).c_str());
  Cluster::create(registry.paths(), id, header.profile, registry.nonce());
  registry.clusters().at(id);
  transfer_pipes::create(registry, registry.paths(), id);
  header.clusters_present.fetch_or(bit);
}

}  // namespace

struct Process::Impl {
  explicit Impl(const Placement & placement_);
  ~Impl();

  struct JoinOnly {};
  /// First half of the other constructor: joins the platform.
  Impl(const Placement & placement_, JoinOnly);

  uint32_t take_process_slot(std::unique_ptr<LifeThread> & life);
  void require_movers();
  uint32_t publish_endpoint(const EndpointSpec & spec, EndpointKind kind);
  uint32_t add_endpoint(const EndpointSpec & spec, EndpointKind kind);
  template<typename Endpoint>
  std::unique_ptr<Endpoint> handle_of(uint32_t endpoint);
  void attach(uint32_t taken);
  void leave();
  void count_contexts(int change) noexcept;

  Placement placement;
  PlatformPaths paths;
  std::unique_ptr<Registry> registry;
  uint32_t slot = nothing;
  std::optional<HeldLifeline> lifeline;
  std::optional<Membership> membership;
  std::unique_ptr<Waiters> waiters;
  std::unique_ptr<Graph> graph;
  std::unique_ptr<ReceiveThreadWatcher> watcher;
  std::mutex contexts_mutex;
  int live_contexts = 0;
};

Process::Impl::Impl(const Placement & placement_, JoinOnly)
: placement(placement_), paths(PlatformPaths::of(placement_.platform)) {
  auto life = std::make_unique<LifeThread>();  // no other process waits for its start
  under_join_lock(paths, [&] {
    ensure_platform(paths, host_profile(), {});
    try {
      registry = std::make_unique<Registry>(paths);
      placement.require_on(registry->header().profile);
      ensure_cluster(*registry, placement.cluster);
      const Registry::Lock lock(*registry);
      slot = take_process_slot(life);
      registry->use_badge_of(slot);
    } catch (...) {
      if (!is_alive(paths)) {
        remove_platform(paths);
      }
      throw;
    }
  });
}

/// Delegates, so that ~Impl() leaves the platform if the rest fails.
Process::Impl::Impl(const Placement & placement_) : Impl(placement_, JoinOnly{}) {
  waiters = std::make_unique<Waiters>(
    registry->header().graph_watchers, slot, registry->processes()[slot].wake, placement.wait_mode);
  graph = std::make_unique<Graph>(*registry);
  watcher = std::make_unique<ReceiveThreadWatcher>(*registry, placement.cluster);
  registry->tracer().follow(
    registry->processes()[slot].trace, identity_of(*registry, slot),
    registry->clusters().at(placement.cluster).header());
  registry->tracer().note(TraceKind::join);
}

/// Makes the reaper of the cluster watch the process that takes this slot, or the reapers of other
/// clusters if the cluster has none. Called before the slot is live: the reaper checks under the
/// registry lock, which this process holds, so it finds the slot even if this process is killed
/// later.
void Process::Impl::attach(uint32_t taken) {
  registry->clusters().at(placement.cluster).wake_reaper(taken);
  if (!registry->lifelines().is_held(receive_thread_line + placement.cluster)) {
    notify_other_reapers(*registry, placement.cluster);
  }
}

uint32_t Process::Impl::take_process_slot(std::unique_ptr<LifeThread> & life) {
  Table<ProcessEntry> & processes = registry->processes();
  SlotAndLine slot_and_line = take_slot_and_line(*registry, life);
  const uint32_t taken = slot_and_line.slot;
  lifeline = std::move(slot_and_line.line);
  ProcessEntry & entry = processes[taken];
  entry.pid = getpid();
  entry.cluster = placement.cluster;
  entry.core = placement.core ? static_cast<int32_t>(*placement.core) : -1;
  entry.host_cpu = only_cpu();
  entry.charged_bytes = 0;
  entry.is_ending.store(0);
  entry.trace.store(scope_of_new_process(registry->header(), placement.cluster));
  std::memset(entry.label, 0, sizeof entry.label);
  std::strncpy(entry.label, placement.label.c_str(), sizeof entry.label - 1);
  entry.wake.reset();
  registry->header().graph_watchers.remove(taken);
  attach(taken);
  processes.publish(taken);
  membership.emplace(*registry, entry.slot);
  return taken;
}

Process::Impl::~Impl() {
  if (membership->is_inherited()) {
    watcher.release();  // its thread belongs to the parent
    return;
  }
  watcher.reset();
  try {
    leave();
  } catch (const std::exception &) {
    // The lock stayed taken: the reaper cleans up after this process.
  }
}

/// The join lock is the user's, not the platform's: it is taken last, and by the last process only,
/// so that no join waits for this one. The registry lock's owner may be stopped.
void Process::Impl::leave() {
  // Close endpoints whose destructors could not get the lock.
  const Cluster & cluster = registry->clusters().at(placement.cluster);
  try {
    close_endpoints_of(*registry, slot, false, [] { return true; });
  } catch (const ClusterUnmappable &) {
    cluster.wake_reaper();  // it has descriptors of its own
    throw;
  }
  {
    const BlockInHand emptied(*registry, registry->parting_wait_ns());  // nothing is left behind
  }
  registry->graph_changed();  // the lock may take a while
  {
    const Registry::Lock lock(*registry, registry->parting_wait_ns());
    registry->tracer().note(TraceKind::leave);
    registry->tracer().unfollow();
    remove_nodes_of(*registry, slot);
    if (registry->header().closing_count != 0) {
      cluster.wake_reaper();
    }
    leave_registry(*registry, slot);
  }
  registry->graph_changed();
  // Of processes that leave at the same time, the one whose line is released last finds no other.
  lifeline.reset();
  if (!is_in_use(*registry)) {
    under_join_lock(paths, [this] { remove_if_unused(*registry); });
  }
}

void Process::Impl::count_contexts(int change) noexcept {
  const std::lock_guard<std::mutex> guard(contexts_mutex);
  live_contexts += change;
  if (membership->holds()) {
    registry->processes()[slot].is_ending.store(live_contexts == 0 ? 1 : 0);
  }
}

/// Returns once the movers of this cluster have their pipes open. A publisher may then end at once
/// after it has handed over its records.
void Process::Impl::require_movers() { ensure_receive_thread(*registry, placement.cluster); }

uint32_t Process::Impl::publish_endpoint(const EndpointSpec & spec, EndpointKind kind) {
  if (transfer::kind_of(registry->find_topic(spec.topic), spec, kind) != Transfer::dsm) {
    require_movers();
  }
  registry->clusters().at(placement.cluster).back_ahead();
  const NeededBlock needed = subscription_block::block_for(spec.qos, placement.cluster);
  std::optional<BlockInHand> hand;
  if (kind == EndpointKind::subscription && needed.bytes > BlockInHand::max_bytes_at_once) {
    hand.emplace(*registry);
    hand->make(*membership, needed);
  }
  return enter_graph(*registry, *membership, spec, kind, slot, hand ? &*hand : nullptr);
}

uint32_t Process::Impl::add_endpoint(const EndpointSpec & spec, EndpointKind kind) {
  check_qos_ranges(spec);
  membership->require();
  joining::require_reach(*registry, spec.topic, kind);
  const uint32_t taken = publish_endpoint(spec, kind);
  try {
    if (kind == EndpointKind::publisher) {
      TopicDsmWriter::open_first_generation(*registry, taken);
    }
    joining::join(*registry, *membership, taken);
  } catch (...) {
    if (membership->holds()) {
      leave_graph(*registry, taken);
    }
    throw;
  }
  return taken;
}

/// Leaves the graph again if there is no memory for the handle.
template<typename Endpoint>
std::unique_ptr<Endpoint> Process::Impl::handle_of(uint32_t endpoint) {
  registry->graph_changed();
  try {
    return std::make_unique<Endpoint>(
      std::make_unique<typename Endpoint::Impl>(*registry, endpoint));
  } catch (...) {
    leave_graph(*registry, endpoint);
    throw;
  }
}

namespace {

/// Memberships of this process. A child of fork() starts anew, with a mutex that no thread holds.
struct Joined {
  static Joined & by_this_process();

  ForkSide side;
  std::mutex mutex;
  std::map<std::string, std::weak_ptr<Process>> processes;
};

Joined & Joined::by_this_process() {
  static std::atomic<Joined *> current{nullptr};
  Joined * known = current.load();
  if (known == nullptr || known->side.is_inherited()) {
    auto fresh = std::make_unique<Joined>();
    if (current.compare_exchange_strong(known, fresh.get())) {
      known = fresh.release();
    }
  }
  return *known;
}

}  // namespace

Process::Process(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Process::~Process() = default;

std::shared_ptr<Process> Process::join(const Placement & placement) {
  if (const virtual_time::Door * const door = virtual_time::door()) {
    door->join();
  }
  Joined & joined = Joined::by_this_process();
  const std::lock_guard<std::mutex> guard(joined.mutex);
  std::weak_ptr<Process> & known = joined.processes[placement.platform];
  if (std::shared_ptr<Process> process = known.lock()) {
    return process;
  }
  std::shared_ptr<Process> process(new Process(std::make_unique<Impl>(placement)));
  known = process;
  return process;
}

uint32_t Process::add_node(
  const std::string & name, const std::string & ns, const std::string & enclave) {
  impl_->membership->require();
  Registry & registry = *impl_->registry;
  uint32_t taken = nothing;
  {
    const Registry::Lock lock(registry);
    taken = registry.nodes().take("nodes");
    NodeEntry & entry = registry.nodes()[taken];
    try {
      store_name(entry.name, name, "node name");
      store_name(entry.ns, ns, "namespace");
      store_name(entry.enclave, enclave, "enclave");
    } catch (...) {
      registry.nodes().give_back(taken);
      throw;
    }
    entry.process = impl_->slot;
    entry.traced.store(0);
    registry.nodes().publish(taken);
  }
  registry.graph_changed();
  return taken;
}

void Process::remove_node(uint32_t node) noexcept {
  if (!impl_->membership->holds()) {
    return;
  }
  try {
    const Registry::Lock lock(*impl_->registry, impl_->registry->parting_wait_ns());
    impl_->registry->nodes().give_back(node);
  } catch (const std::exception &) {
    // The registry stayed locked: the node is removed with this process.
  }
  impl_->registry->graph_changed();
}

std::unique_ptr<Publisher> Process::create_publisher(const EndpointSpec & spec) {
  return impl_->handle_of<Publisher>(impl_->add_endpoint(spec, EndpointKind::publisher));
}

std::unique_ptr<Subscription> Process::create_subscription(const EndpointSpec & spec) {
  auto subscription =
    impl_->handle_of<Subscription>(impl_->add_endpoint(spec, EndpointKind::subscription));
  subscription->arrivals();  // looks for a history: without one, nothing must seem to wait
  return subscription;
}

bool Process::is_cut_off() const noexcept { return impl_->membership->is_cut_off(); }

bool Process::is_inherited() const noexcept { return impl_->membership->is_inherited(); }

void Process::require_membership() const { impl_->membership->require(); }

std::vector<ProcessInfo> Process::beside() const {
  const Placement & own = impl_->placement;
  std::vector<ProcessInfo> found;
  for (ProcessInfo & other : impl_->graph->processes()) {
    const bool is_same_core =
      own.core && other.cluster == own.cluster && other.core == static_cast<int32_t>(*own.core);
    const bool is_other = other.slot != impl_->slot && other.pid != getppid();
    if (is_same_core && is_other && impl_->registry->lifelines().is_held(other.slot)) {
      found.push_back(std::move(other));
    }
  }
  return found;
}

void Process::begin_context() noexcept { impl_->count_contexts(1); }

void Process::end_context() noexcept { impl_->count_contexts(-1); }

Waiters & Process::waiters() noexcept { return *impl_->waiters; }
Tracer & Process::tracer() noexcept { return impl_->registry->tracer(); }
Graph & Process::graph() noexcept { return *impl_->graph; }
const Placement & Process::placement() const noexcept { return impl_->placement; }

}  // namespace manycore
