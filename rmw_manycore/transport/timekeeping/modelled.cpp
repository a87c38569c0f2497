// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Timekeeper: threads whose steps take the time that the platform model predicts.

#include <algorithm>
#include <map>
#include <utility>

#include "transport/layout/subscription_layout.hpp"
#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {

using virtual_time::never_ns;
using virtual_time::seat_waiting;
using virtual_time::start_ns;
using virtual_time::Step;

static_assert(endpoint_capacity <= virtual_time::subscription_capacity);

namespace {

std::string full_name(const NodeEntry & node) {
  const std::string ns = node.ns;
  return ns + (ns == "/" ? "" : "/") + node.name;
}

}  // namespace

/// `STEP SUBJECT NODE ROLE PROGRAM`: the subject is a period in ns, or a topic.
std::string Timekeeper::words_of(const Seat & seat) const {
  const std::string program = " " + programs_.at(seat.rank).name;
  switch (seat.next) {
    case Step::timer:
      return "timer " + std::to_string(seat.subject) + " - -" + program;
    case Step::take:
    case Step::publish: {
      const EndpointEntry & entry = registry_.endpoints()[static_cast<uint32_t>(seat.subject)];
      const std::string node = full_name(registry_.nodes()[entry.node]);
      const char * const verb = seat.next == Step::take ? "take " : "publish ";
      const char * const role = entry.role == EndpointRole::topic ? " topic" : " service";
      return verb + std::string(entry.topic) + " " + node + role + program;
    }
    case Step::woken:
      return "woken - - -" + program;
    default:
      return "wait - - -" + program;
  }
}

/// Gives the model the next steps of the threads that have settled, in the order of threads.
void Timekeeper::ask_model() {
  if (model_ == nullptr) {
    return;
  }
  std::map<Key, uint32_t> asking;
  for (uint32_t i = 0; i < std::min(page_.seat_count.load(), virtual_time::seat_capacity); ++i) {
    const Seat & seat = page_.seats[i];
    const auto known = asked_.find(i);
    const bool asks =
      seat.state.load(std::memory_order_acquire) == seat_waiting && seat.next != Step::none;
    if (asks && (known == asked_.end() || known->second != seat.tid)) {
      asking[key_of(seat)] = i;
    }
  }
  for (const auto & [key, i] : asking) {
    asked_[i] = page_.seats[i].tid;
    model_->ask({i, page_.seats[i].tid}, words_of(page_.seats[i]));
  }
  resume_model();
}

void Timekeeper::resume_model() {
  if (std::exchange(is_model_waiting_, false)) {
    model_->resume();
  }
}

/// A wait does not see messages that are all under way. When the first one has arrived, it looks
/// again.
void Timekeeper::note(const PlatformModel::Passage & passage) {
  const auto & endpoints = registry_.endpoints();
  for (uint32_t slot = 0; slot < endpoints.high_water(); ++slot) {
    const EndpointEntry & entry = endpoints[slot];
    if (
      !endpoints.is_live(slot) || entry.kind != EndpointKind::subscription ||
      entry.role != EndpointRole::topic || entry.topic != passage.topic ||
      full_name(registry_.nodes()[entry.node]) != passage.node) {
      continue;
    }
    const uint32_t incarnation = entry.slot.incarnation.load(std::memory_order_relaxed);
    page_.under_way[slot].store(passage.is_over ? 0 : incarnation, std::memory_order_release);
    Cluster * const cluster = passage.is_over ? registry_.clusters().find(entry.cluster) : nullptr;
    if (cluster != nullptr) {
      const auto * const header = cluster->find<SubscriptionHeader>(entry.block.offset());
      registry_.processes()[entry.process].wake.notify(header->watchers.read());
    }
  }
}

/// Lets time pass on the platform; false if nothing happens there until `until_ns`.
bool Timekeeper::advance_model(int64_t until_ns) {
  resume_model();
  const auto answer = model_->advance(until_ns == never_ns ? -1 : until_ns - start_ns);
  for (const PlatformModel::Passage & passage : answer.passages) {
    note(passage);
  }
  if (!answer.done && !answer.is_waiting) {
    return false;
  }
  page_.now_ns.store(start_ns + answer.at_ns, std::memory_order_release);
  is_model_waiting_ = true;
  if (!answer.done) {
    return true;
  }
  const auto asked = asked_.find(answer.done->seat);
  if (asked != asked_.end() && asked->second == answer.done->tid) {  // else a successor has asked
    asked_.erase(asked);
  }
  Seat & seat = page_.seats[answer.done->seat];
  const bool waits = seat.state.load(std::memory_order_acquire) == seat_waiting;
  if (waits && seat.next != Step::none && seat.tid == answer.done->tid) {
    let_go(seat);
  }  // else the thread has died
  return true;
}

}  // namespace manycore
