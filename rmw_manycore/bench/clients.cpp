// Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
// How much do the clients of a service slow each other down, at the rcl level?
//
//   clients role=server
//   clients role=idle clients=N
//   clients role=caller warm_up=N iterations=N
//
// The service is one of a node's parameter services. Server and idle clients print "ready" when
// they wait, and end when their input ends. The caller's samples are the durations of its calls.
#include <rcl/graph.h>
#include <rcl_interfaces/srv/get_parameter_types.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "bench/program.hpp"
#include "bench/rcl_node.hpp"
#include "platform/clock.hpp"

namespace {

using namespace manycore::bench;
using manycore::monotonic_ns;

constexpr const char * server_name = "server";
constexpr const char * service_name = "/server/get_parameter_types";
constexpr auto poll_period = std::chrono::milliseconds(5);

const rosidl_service_type_support_t * service_type() {
  return ROSIDL_GET_SRV_TYPE_SUPPORT(rcl_interfaces, srv, GetParameterTypes);
}

/// Calls `act` after each wait, in a separate thread, until the input ends.
template<typename Act>
void spin_until_end_of_input(RclContext & context, const RclNode & node, Act act) {
  RclGuardCondition end(context);
  RclWaitSet wait_set(context.get(), {&node}, end);
  std::thread waiter([&] {
    for (wait_set.wait(); !wait_set.is_ended(); wait_set.wait()) {
      act();
    }
  });
  announce_ready();
  wait_for_end_of_input();
  end.trigger();
  waiter.join();
}

void answer(const rcl_service_t & service) {
  rcl_interfaces__srv__GetParameterTypes_Request request;
  rcl_interfaces__srv__GetParameterTypes_Request__init(&request);
  rmw_request_id_t id;
  const rcl_ret_t status = rcl_take_request(&service, &id, &request);
  rcl_interfaces__srv__GetParameterTypes_Request__fini(&request);
  if (status == RCL_RET_SERVICE_TAKE_FAILED) {
    return;
  }
  check_rcl(status, "rcl_take_request");
  rcl_interfaces__srv__GetParameterTypes_Response response;
  rcl_interfaces__srv__GetParameterTypes_Response__init(&response);
  check_rcl(rcl_send_response(&service, &id, &response), "rcl_send_response");
  rcl_interfaces__srv__GetParameterTypes_Response__fini(&response);
}

void serve() {
  RclContext context;
  const RclNode node(context.get(), server_name);
  for (const rcl_service_t & service : node.services()) {
    if (std::string(rcl_service_get_service_name(&service)) == service_name) {
      return spin_until_end_of_input(context, node, [&service] { answer(service); });
    }
  }
  throw std::runtime_error(std::string("a node has no service ") + service_name);
}

void idle(const Arguments & arguments) {
  RclContext context;
  RclNode node(context.get(), "idle");
  for (size_t i = 0; i < arguments.number("clients"); ++i) {
    node.call(service_name, service_type());
  }
  spin_until_end_of_input(context, node, [] {});
}

void wait_for_server(RclNode & node, const rcl_client_t & client) {
  for (bool is_there = false; !is_there; std::this_thread::sleep_for(poll_period)) {
    check_rcl(
      rcl_service_server_is_available(&node.get(), &client, &is_there), "rcl_service_server");
  }
}

void take_response(RclWaitSet & wait_set, const rcl_client_t & client) {
  rcl_interfaces__srv__GetParameterTypes_Response response;
  rcl_interfaces__srv__GetParameterTypes_Response__init(&response);
  rcl_ret_t status = RCL_RET_CLIENT_TAKE_FAILED;
  while (status == RCL_RET_CLIENT_TAKE_FAILED) {
    wait_set.wait();
    rmw_request_id_t id;
    status = rcl_take_response(&client, &id, &response);
  }
  check_rcl(status, "rcl_take_response");
  rcl_interfaces__srv__GetParameterTypes_Response__fini(&response);
}

void call(const Arguments & arguments) {
  RclContext context;
  RclNode node(context.get(), "caller");
  const rcl_client_t & client = node.call(service_name, service_type());
  wait_for_server(node, client);
  const RclGuardCondition end(context);
  RclWaitSet wait_set(context.get(), {&node}, end);
  rcl_interfaces__srv__GetParameterTypes_Request request;
  rcl_interfaces__srv__GetParameterTypes_Request__init(&request);
  const size_t warm_up = arguments.number("warm_up");
  std::vector<int64_t> samples_ns;
  for (size_t i = 0; i < warm_up + arguments.number("iterations"); ++i) {
    const int64_t start_ns = monotonic_ns();
    int64_t number = 0;
    check_rcl(rcl_send_request(&client, &request, &number), "rcl_send_request");
    take_response(wait_set, client);
    if (i >= warm_up) {
      samples_ns.push_back(monotonic_ns() - start_ns);
    }
  }
  rcl_interfaces__srv__GetParameterTypes_Request__fini(&request);
  print_samples(samples_ns);
}

}  // namespace

int main(int argc, char ** argv) {
  return run_program(argc, argv, [](const Arguments & arguments) {
    const std::string role = arguments.text("role");
    role == "server" ? serve() : role == "idle" ? idle(arguments) : call(arguments);
  });
}
