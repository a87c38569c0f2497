// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
//
// Succeeds if an exception of Fast CDR leaves a take and a publication as one of rmw_manycore.

#include <cstdio>

#include "rmw/serialization/cdr.cpp"

// As in the library, whose exceptions may have another base class than those of this program.
namespace eprosima::fastcdr::exception {
Exception::Exception(const char * const & message) noexcept : m_message(message) {}
Exception::~Exception() noexcept = default;
const char * Exception::what() const noexcept { return m_message; }
}  // namespace eprosima::fastcdr::exception

namespace {

class Refusal : public eprosima::fastcdr::exception::Exception {
public:
  Refusal() : Exception("refused") {}
  void raise() const override { throw *this; }
};

message_type_support_callbacks_t callbacks() {
  message_type_support_callbacks_t made{};
  made.cdr_serialize = [](const void *, eprosima::fastcdr::Cdr &) -> bool { throw Refusal(); };
  made.cdr_deserialize = [](eprosima::fastcdr::Cdr &, void *) -> bool { throw Refusal(); };
  made.max_serialized_size = [](char &) -> size_t { return 0; };
  return made;
}

template<typename Body>
bool fails(Body && body) {
  try {
    body();
  } catch (const manycore::Error & error) {
    return std::string(error.what()) == "refused";
  }
  return false;
}

}  // namespace

int main() {
  const message_type_support_callbacks_t type = callbacks();
  const rosidl_message_type_support_t unknown{
    "none",
    &type,
    [](const rosidl_message_type_support_t *, const char *)
      -> const rosidl_message_type_support_t * { return nullptr; },
    nullptr,
    nullptr,
    nullptr};
  const rmw_manycore::Cdr cdr(type, std::make_shared<rmw_manycore::CdrLengths>(unknown));
  uint8_t data[8] = {0, 1};
  int message = 0;
  return fails([&] { cdr.serialize(&message, data, sizeof(data)); }) &&
             fails([&] { cdr.deserialize(data, sizeof(data), &message); })
           ? 0
           : 1;
}
