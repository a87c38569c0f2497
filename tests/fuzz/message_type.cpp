// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#include "message_type.hpp"

#include <dlfcn.h>

#include <new>
#include <stdexcept>

#include "rosidl_typesupport_introspection_cpp/message_introspection.hpp"

namespace {

using CppMembers = rosidl_typesupport_introspection_cpp::MessageMembers;

constexpr const char * introspection_c = "rosidl_typesupport_introspection_c";
constexpr const char * introspection_cpp = "rosidl_typesupport_introspection_cpp";

/// Type support from the library of a generated package, which stays loaded.
const rosidl_message_type_support_t * load(const std::string & type, const std::string & library) {
  const size_t end_of_package = type.find('/');
  const size_t end_of_kind = type.rfind('/');
  const std::string package = type.substr(0, end_of_package);
  const std::string kind = type.substr(end_of_package + 1, end_of_kind - end_of_package - 1);
  const std::string message = type.substr(end_of_kind + 1);
  const std::string file = "lib" + package + "__" + library + ".so";
  void * const handle = dlopen(file.c_str(), RTLD_LAZY);
  if (handle == nullptr) {
    throw std::runtime_error(dlerror());
  }
  const std::string symbol =
    library + "__get_message_type_support_handle__" + package + "__" + kind + "__" + message;
  using Getter = const rosidl_message_type_support_t * (*)();
  const auto getter = reinterpret_cast<Getter>(dlsym(handle, symbol.c_str()));
  if (getter == nullptr) {
    throw std::runtime_error(dlerror());
  }
  return getter();
}

/// Both languages describe creation and destruction of a message, each in its own structures.
template<typename AnyMembers, typename Initialization>
std::shared_ptr<void> create_as(const void * members, Initialization initialization) {
  const auto & type = *static_cast<const AnyMembers *>(members);
  void * const message = ::operator new(type.size_of_);
  type.init_function(message, initialization);
  return {message, [&type](void * old) {
            type.fini_function(old);
            ::operator delete(old);
          }};
}

}  // namespace

MessageType::MessageType(const std::string & name, Language language)
: name_(name),
  support_(load(name, language == Language::c ? "rosidl_typesupport_c" : "rosidl_typesupport_cpp")),
  members_(load(name, language == Language::c ? introspection_c : introspection_cpp)->data),
  language_(language) {}

std::shared_ptr<void> MessageType::create() const {
  return language_ == Language::c
           ? create_as<Members>(members_, ROSIDL_RUNTIME_C_MSG_INIT_ALL)
           : create_as<CppMembers>(members_, rosidl_runtime_cpp::MessageInitialization::ALL);
}

const Members & members_of(const std::string & name) {
  return *static_cast<const Members *>(load(name, introspection_c)->data);
}
