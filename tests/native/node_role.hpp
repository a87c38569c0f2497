// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "child.hpp"
#include "platform_of_test.hpp"

/// For roles: joins, says so, and stays until it is told anything.
void join_and_stay(Lines & test, const std::string & platform);

/// A node in a process of its own that does what it is told:
///   publisher TOPIC QOS           -> ok     one publisher ..
///   subscription TOPIC QOS        -> ok     .. and one subscription at a time
///   matched COUNT                 -> ok     once its endpoint has that many matches
///   publish FIRST LAST SIZE       -> ok     messages of these numbers, by writer = its pid
///   publish_endlessly SIZE                  until it is killed; numbers from 1
///   take FIRST LAST WRITER        -> ok     these messages, in this order, none else
///   take_ordered LAST WRITER      -> COUNT  messages of one writer in order, up to this number
///   look                          -> NUMBER of what the next hint leads to, or "nothing"
///   claim                         -> NUMBER holds the next message ..
///   release                       -> ok     .. which is still what it was
///   close                         -> ok     publisher and subscription go
///   use_up_descriptors            -> ok     from now on it can open no file ..
///   free_descriptors              -> ok     .. and now it can
///   begin_context                 -> ok
///   end_context                   -> ok     its end is intended once all that began have ended
///   leave                                   ends
/// QOS: keep_all, or a depth, or a depth with "transient_local", "best_effort", "deadline" or
/// "lease" (of an hour) after a '+'.
class Node : public Child {
public:
  Node(const TestPlatform & platform, uint32_t cluster, const std::string & wait = "block")
  : Child("node", {platform.name(), std::to_string(cluster), wait}) {
    expect("joined");
  }
  /// Says `command`; throws unless the answer is "ok".
  void tell(const std::string & command) {
    say(command);
    expect("ok");
  }
  std::string ask(const std::string & command) {
    say(command);
    return hear();
  }
  std::string id() const { return std::to_string(pid()); }
};
