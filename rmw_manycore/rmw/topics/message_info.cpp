// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "rmw/topics/message_info.hpp"

#include <algorithm>

#include "rmw/common/identifier.hpp"

namespace rmw_manycore {

static_assert(sizeof(manycore::Gid) == RMW_GID_STORAGE_SIZE);

rmw_gid_t to_rmw(const manycore::Gid & gid) {
  rmw_gid_t result{};
  result.implementation_identifier = identifier;
  std::copy(gid.begin(), gid.end(), result.data);
  return result;
}

rmw_message_info_t to_rmw(const manycore::RecordInfo & info) {
  rmw_message_info_t result = rmw_get_zero_initialized_message_info();
  result.source_timestamp = info.source_timestamp_ns;
  result.received_timestamp = info.received_timestamp_ns;
  result.publication_sequence_number = info.publication_sequence_number;
  result.reception_sequence_number = info.reception_sequence_number;
  result.publisher_gid = to_rmw(info.publisher);
  // Refers to rclcpp's own intra-process path, which bypasses the RMW.
  result.from_intra_process = false;
  return result;
}

rmw_service_info_t to_service_info(const manycore::RecordInfo & info) {
  rmw_service_info_t result{};
  result.source_timestamp = info.source_timestamp_ns;
  result.received_timestamp = info.received_timestamp_ns;
  const manycore::Gid & client = info.correlation.client;
  std::copy(client.begin(), client.end(), result.request_id.writer_guid);
  result.request_id.sequence_number = info.correlation.number;
  return result;
}

manycore::Correlation to_correlation(const rmw_request_id_t & id) {
  manycore::Correlation result;
  std::copy(std::begin(id.writer_guid), std::end(id.writer_guid), result.client.begin());
  result.number = id.sequence_number;
  return result;
}

}  // namespace rmw_manycore
