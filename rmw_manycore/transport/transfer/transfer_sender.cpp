// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "transport/transfer/transfer_sender.hpp"

#include <string>
#include <utility>

#include "platform/clock.hpp"
#include "platform/error.hpp"

namespace manycore {

namespace {

TransferSettings settings_of(const Registry & registry, const EndpointEntry & publisher) {
  const TopicEntry * const topic =
    publisher.transfer == Transfer::dsm ? nullptr : registry.find_topic(publisher.topic);
  return topic == nullptr ? TransferSettings{} : topic->transfer;
}

}  // namespace

TransferSender::TransferSender(Registry & registry, Cluster & own, EndpointEntry & publisher)
: TransferSender(registry, own, publisher, settings_of(registry, publisher)) {}

TransferSender::TransferSender(
  Registry & registry, Cluster & own, EndpointEntry & publisher, const TransferSettings & settings)
: registry_(registry),
  own_(own),
  publisher_(publisher),
  dsm_(*own.find<TopicDsmHeader>(publisher.block.offset())),
  carrier_(make_carrier(registry.paths(), own, settings)),
  is_synchronous_(settings.kind == Transfer::message && settings.synchronous != 0) {}

void TransferSender::begin(uint64_t number) noexcept {
  if (std::exchange(number_, number) != number) {
    late_ = {};
    until_ns_ = is_synchronous_ ? monotonic_ns() + max_blocking_ns : 0;
  }
}

/// The record was made by this publisher just now; its topic DSM has one generation.
Carried TransferSender::carry(
  const EmcosMessage & announcement, const Landing & landing, const Cluster & receiver) noexcept {
  const GenerationEntry & only = dsm_.generations[0];
  const uint64_t count = only.descriptor_count.load(std::memory_order_relaxed);
  const auto * const descriptors =
    own_.find<RecordDescriptor>(only.offset.load(std::memory_order_relaxed));
  const RecordDescriptor & record = descriptors[number_ & (count - 1)];
  const RecordPlace place{record.offset - only.data_offset(), record.size_bytes};
  const auto * const data = own_.find<uint8_t>(record.offset, record.size_bytes);
  registry_.tracer().note(TraceKind::hand, announcement.endpoint, number_, receiver.id());
  return carrier_->carry({announcement, place, data, until_ns_}, landing, receiver);
}

/// Dekker with the successor of a killed receive thread: it counts itself, then gives up what is
/// `handed` and not in its pipes. So either it has seen this record, or it is seen here. A record
/// that arrives all the same is delivered, unless the readers have counted it as lost by then.
bool TransferSender::note_handed(
  LandingHeader & landing, const std::atomic<uint64_t> & successors, uint64_t before) noexcept {
  const uint64_t handed = landing.handed.load(std::memory_order_relaxed);
  landing.handed.store(number_, std::memory_order_seq_cst);
  const bool is_safe = successors.load(std::memory_order_seq_cst) == before ||
                       landing.done.load(std::memory_order_seq_cst) >= number_;
  if (!is_safe) {
    landing.handed.store(handed, std::memory_order_seq_cst);
  }
  return is_safe;
}

void TransferSender::note_dropped(uint32_t cluster) noexcept {
  publisher_.counters.dropped.fetch_add(1, std::memory_order_relaxed);
  registry_.tracer().note(TraceKind::drop, dsm_.endpoint.load(), number_, cluster);
}

/// A report wakes the whole cluster, so only the first of the drops in a row is reported. The
/// others are found by the subscriptions after a record that is still under way. Dekker with the
/// mover: `decided` was stored before `done` is loaded here, and a subscription looks at `decided`
/// after the mover has stored `done`.
bool TransferSender::is_told_of_drop(const LandingHeader & landing, uint32_t cluster) noexcept {
  const uint64_t bit = uint64_t{1} << (cluster - 1);
  const bool was_dropping = (std::exchange(dropping_, dropping_ | bit) & bit) != 0;
  return was_dropping && landing.done.load(std::memory_order_seq_cst) <
                           landing.handed.load(std::memory_order_relaxed);
}

bool TransferSender::is_given_up(const Landing & landing) const noexcept {
  return landing.header().done.load(std::memory_order_seq_cst) >= number_ && !landing.has(number_);
}

bool TransferSender::transfer(
  const EmcosMessage & announcement, const Cluster & receiver) noexcept {
  const Landing landing = Landing::of(own_, dsm_, receiver);
  if (!landing) {
    return true;  // the last subscription there is closing
  }
  begin(announcement.number);
  LandingHeader & header = landing.header();
  const std::atomic<uint64_t> & successors =
    (publisher_.transfer == Transfer::session ? own_ : receiver).header().successors;
  const uint64_t before = successors.load(std::memory_order_seq_cst);
  Carried carried = carry(announcement, landing, receiver);
  const bool may_arrive = carried != Carried::dropped;
  if (may_arrive && !note_handed(header, successors, before)) {
    carried = Carried::dropped;
  }
  if (carried == Carried::dropped) {
    note_dropped(receiver.id());
  } else {
    dropping_ &= ~(uint64_t{1} << (receiver.id() - 1));
  }
  header.decided.store(number_, std::memory_order_seq_cst);
  if (is_synchronous_ && carried != Carried::handed && Landing::of(own_, dsm_, receiver)) {
    note_late({receiver.id(), may_arrive});  // unless its last subscription has left meanwhile
  }
  return carried == Carried::dropped ? is_told_of_drop(header, receiver.id())
                                     : carried != Carried::unannounced && !is_given_up(landing);
}

void TransferSender::note_late(const Late & late) noexcept {
  if (late_.cluster == 0 || late_.may_arrive) {
    late_ = late;
  }
}

void TransferSender::throw_late() {
  const Late late = std::exchange(late_, {});
  const std::string time = std::to_string(max_blocking_ns / 1'000'000) + " ms";
  const std::string advice =
    late.may_arrive
      ? " has not yet received the message after " + time +
          "; it may still arrive: do not publish it again, unless a second copy does no harm"
      : " had no room for the message within " + time + "; it was dropped there: publish it again";
  throw Error(
    ErrorCode::timeout, "publish on '" + text_of(publisher_.topic) +
                          "' timed out: it is synchronous, and cluster " +
                          std::to_string(late.cluster) + advice);
}

}  // namespace manycore
