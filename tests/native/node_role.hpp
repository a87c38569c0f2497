// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "child.hpp"
#include "platform_of_test.hpp"

/// For roles: joins the platform, reports it, and stays until the next command.
void join_and_stay(Lines & test, const std::string & platform);

/// A node in its own process that executes commands:
///   publisher TOPIC QOS           -> ok     one publisher ..
///   subscription TOPIC QOS        -> ok     .. and one subscription at a time
///   matched COUNT                 -> ok     once its endpoint has that many matches
///   publish FIRST LAST SIZE       -> ok     messages of these numbers, by writer = its pid
///   publish_endlessly SIZE                  until it is killed; numbers from 1
///   take FIRST LAST WRITER        -> ok     exactly these messages, in this order
///   take_ordered LAST WRITER      -> COUNT  messages of one writer in order, up to this number
///   take_all                      -> ok     takes what is there, if anything
///   look                          -> NUMBER taken after the next hint, or "nothing"
///   claim                         -> NUMBER holds the next message ..
///   release                       -> ok     .. which must be unchanged
///   close                         -> ok     closes publisher and subscription
///   use_up_descriptors            -> ok     from now on it cannot open files ..
///   free_descriptors              -> ok     .. and now it can again
///   begin_context                 -> ok
///   end_context                   -> ok     its end is intended once all that began have ended
///   leave                                   ends
/// QOS: keep_all, or a depth, or a depth followed by '+' and "transient_local", "best_effort",
/// "deadline" or "lease" (both of an hour).
class Node : public Child {
public:
  Node(const TestPlatform & platform, uint32_t cluster, const std::string & wait = "block")
  : Child("node", {platform.name(), std::to_string(cluster), wait}) {
    expect("joined");
  }
  /// Sends `command`. Throws unless the answer is "ok".
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
