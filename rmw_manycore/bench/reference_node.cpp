// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// One node of the Autoware reference system at the rcl level, with the entities that rclcpp
// creates, in a process with one thread for its callbacks, until SIGINT or SIGTERM.
//
//   reference_node name=N kind=K inputs=A,B outputs=C period_ms=N crunch_us=N message=TYPE
//     payload=untouched|checked depth=N report_period_ms=N
//
// A depth of 0 keeps all messages. Command nodes print the reference system's statistics, at most
// once per `report_period_ms`; all nodes print "lost N of TOPIC at NANOSECONDS".

#include "bench/program.hpp"
#include "bench/reference/executor.hpp"

namespace {

using namespace manycore::bench;
using namespace manycore::bench::reference;

// Depth of command nodes where other nodes have 1.
constexpr size_t command_depth = 10;

Settings settings_of(const Arguments & arguments) {
  const bool is_command = arguments.text("kind") == "command";
  const size_t depth = arguments.number("depth");
  return {
    arguments.text("name"),
    arguments.text("kind"),
    arguments.list("inputs"),
    is_command ? std::vector<std::string>{} : arguments.list("outputs"),
    std::chrono::milliseconds(arguments.number("period_ms")),
    static_cast<int64_t>(arguments.number("crunch_us")) * 1000,
    arguments.number("report_period_ms") * 1'000'000,
    {
      message_type(arguments.text("message")),
      arguments.text("payload") == "checked",
      is_command && depth != 0 ? command_depth : depth,
    },
  };
}

void run(const Arguments & arguments) {
  block_interruptions();
  const Settings settings = settings_of(arguments);
  RclContext context;
  RclNode node(context.get(), settings.name);
  const std::unique_ptr<Kind> kind = make_kind(node, settings);
  const Interruption end(context);
  spin(context, node, *kind, end);
  for (Input & input : kind->inputs()) {
    input.say_losses();
  }
}

}  // namespace

int main(int argc, char ** argv) { return run_program(argc, argv, run); }
