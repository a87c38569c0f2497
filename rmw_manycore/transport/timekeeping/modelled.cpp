// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// Part of Timekeeper: threads whose steps take the time that the platform model predicts.

#include <algorithm>
#include <map>
#include <utility>

#include "transport/timekeeping/timekeeper.hpp"

namespace manycore {

using virtual_time::never_ns;
using virtual_time::seat_waiting;
using virtual_time::start_ns;
using virtual_time::Step;

/// `STEP SUBJECT NODE ROLE PROGRAM`: the subject is a period or a time in ns, or a topic.
std::string Timekeeper::words_of(const Seat & seat) const {
  const std::string program = " " + programs_.at(seat.rank).name;
  switch (seat.next) {
    case Step::timer:
      return "timer " + std::to_string(seat.subject) + " - -" + program;
    case Step::take:
    case Step::publish: {
      const EndpointEntry & entry = registry_.endpoints()[static_cast<uint32_t>(seat.subject)];
      const NodeEntry & node = registry_.nodes()[entry.node];
      const std::string ns = node.ns;
      const char * const verb = seat.next == Step::take ? "take " : "publish ";
      const char * const role = entry.role == EndpointRole::topic ? " topic" : " service";
      return verb + std::string(entry.topic) + " " + ns + (ns == "/" ? "" : "/") + node.name +
             role + program;
    }
    case Step::woken: {
      const auto due_ns = static_cast<int64_t>(seat.subject);
      return "woken " + (due_ns == never_ns ? "inf" : std::to_string(due_ns - start_ns)) + " - -" +
             program;
    }
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
  if (std::exchange(is_model_waiting_, false)) {
    model_->resume();
  }
}

/// Lets time pass on the platform; false if nothing happens there until `until_ns`.
bool Timekeeper::advance_model(int64_t until_ns) {
  const auto answer = model_->advance(until_ns == never_ns ? -1 : until_ns - start_ns);
  if (!answer.done) {
    return false;
  }
  page_.now_ns.store(start_ns + answer.at_ns, std::memory_order_release);
  const auto asked = asked_.find(answer.done->seat);
  if (asked != asked_.end() && asked->second == answer.done->tid) {  // else a successor has asked
    asked_.erase(asked);
  }
  Seat & seat = page_.seats[answer.done->seat];
  const bool waits = seat.state.load(std::memory_order_acquire) == seat_waiting;
  if (waits && seat.next != Step::none && seat.tid == answer.done->tid) {
    is_model_waiting_ = true;
    let_go(seat);
  } else {
    model_->resume();  // the thread has died
  }
  return true;
}

}  // namespace manycore
