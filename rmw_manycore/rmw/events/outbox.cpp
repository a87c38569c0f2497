// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/events/outbox.hpp"

namespace rmw_manycore {
namespace {

/// Reports at its end, whether or not publishing throws: readers may have been notified before.
class Report {
public:
  Report(
    CallbackThread & thread, const MessageTopic & topic, const manycore::WakeSet & spared) noexcept
  : thread_(thread), topic_(topic), spared_(spared) {}
  ~Report() {
    if (!spared_.empty()) {
      thread_.report(topic_);
    }
  }
  Report(const Report &) = delete;
  Report & operator=(const Report &) = delete;

private:
  CallbackThread & thread_;
  const MessageTopic & topic_;
  const manycore::WakeSet spared_;
};

}  // namespace

void Outbox::publish(
  manycore::Draft && draft, size_t size_bytes, int64_t source_timestamp_ns,
  const manycore::Correlation & correlation) {
  // A transferred message may wait for another cluster once it has arrived in this one.
  const bool may_wait = publisher_->transfer() != manycore::Transfer::dsm;
  const manycore::WakeSet spared = may_wait ? manycore::WakeSet{} : thread_.spared(topic_);
  const Report report(thread_, topic_, spared);
  publisher_->publish(std::move(draft), size_bytes, source_timestamp_ns, correlation, spared);
}

}  // namespace rmw_manycore
