// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// The error of a message that is too large names the rule and sizes that help: they are tried.
#include <doctest/doctest.h>

#include "messages.hpp"
#include "platform_of_test.hpp"
#include "transport/lifecycle/configurator.hpp"
#include "waiting.hpp"

using namespace manycore;

namespace {

constexpr uint64_t mebibyte = 1 << 20;

/// Publishes a message of `size_bytes` on a platform with so much SMEM.
Refusal refusal_of_message(uint64_t size_bytes, uint64_t smem_bytes, uint64_t topic_dsm_size = 0) {
  const TestPlatform platform;
  Profile profile = host_profile();
  profile.smem_bytes = smem_bytes;
  const TopicConfiguration topic{"/large", 1, static_cast<uint32_t>(topic_dsm_size), 0};
  const Configurator configurator(platform.name(), profile, {topic});
  const auto process = platform.join();
  const auto publisher = process->create_publisher(on_topic("/large", keep_last(1)));
  return refusal_of([&] { publish(*publisher, 1, size_bytes); });
}

/// The number behind a word of the refusal; 0 if it is not there.
uint64_t number_behind(const Refusal & refusal, const std::string & word) {
  const size_t found = refusal.text.find(word + " to at least ");
  return found == std::string::npos
           ? 0
           : std::stoull(refusal.text.substr(refusal.text.find_first_of("0123456789", found)));
}

}  // namespace

TEST_CASE("a message larger than half of the SMEM: both sizes that the error names help") {
  constexpr uint64_t smem_bytes = 16 * mebibyte;
  for (const uint64_t size_bytes : {8 * mebibyte + 1, 9 * mebibyte, 13 * mebibyte}) {
    const Refusal refusal = refusal_of_message(size_bytes, smem_bytes);
    CHECK(refusal.code == ErrorCode::too_large);
    CHECK_MESSAGE(refusal.says("at most half of the SMEM of its cluster"), refusal.text);
    const uint64_t smem = number_behind(refusal, "smem_size");
    CHECK_FALSE(refusal_of_message(size_bytes, smem).code);
    CHECK(refusal_of_message(size_bytes, smem - mebibyte).code);
    const uint64_t topic_dsm = number_behind(refusal, "topic_dsm_size");
    CHECK_FALSE(refusal_of_message(size_bytes, smem_bytes, topic_dsm).code);
  }
}

TEST_CASE("a message larger than the SMEM: only a larger SMEM helps") {
  const Refusal refusal = refusal_of_message(20 * mebibyte, 16 * mebibyte);
  CHECK(number_behind(refusal, "topic_dsm_size") == 0);
  CHECK_FALSE(refusal_of_message(20 * mebibyte, number_behind(refusal, "smem_size")).code);
}

TEST_CASE("a message larger than a fixed topic DSM: the size that the error names helps") {
  const Refusal refusal = refusal_of_message(3 * mebibyte, 16 * mebibyte, mebibyte);
  CHECK(refusal.code == ErrorCode::too_large);
  const uint64_t topic_dsm = number_behind(refusal, "topic_dsm_size");
  CHECK_FALSE(refusal_of_message(3 * mebibyte, 16 * mebibyte, topic_dsm).code);
  CHECK(refusal_of_message(3 * mebibyte, 16 * mebibyte, topic_dsm - mebibyte).code);
}
