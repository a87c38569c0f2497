# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topics through the bridge, between real nodes on rmw_manycore and real nodes on Fast DDS."""

from __future__ import annotations

import re
import signal
import time

import pytest

from support import IS_MANYCORE, MAPFILES, TIMEOUT_S, wait_until
from support.nodes.bridging import OUTSIDE
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.speakers import hear, qos, say
from support.peers.programs import forked_example, forked_manycore
from support.processes.platforms import leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the bridge is part of rmw_manycore"),
]

TALKER_LISTENER = MAPFILES / "talker_listener.yaml"
MANY = 500  # messages at once: more than the bridge forwards before it looks at the graph
DEEP = {"depth": 1000}  # more than is published within a test's timeout
HEARD = "I heard: 'Hello World"


def say_much_and_leave(topic: str, count: int) -> None:
    """Publish periodically; on request publish `count` numbers at once and end."""
    from rclpy.duration import Duration

    told: list[int] = []
    signal.signal(signal.SIGUSR1, lambda number, _: told.append(number))
    with peer_node("speaker") as node:
        message = type_of("std_msgs/msg/String")
        publisher = node.create_publisher(message, topic, qos({"depth": count}))
        node.create_timer(0.05, lambda: publisher.publish(message(data="again")))
        announce("saying")
        spin_until(node, lambda: told)
        for number in range(count):
            publisher.publish(message(data=str(number)))
        publisher.wait_for_all_acked(Duration(seconds=TIMEOUT_S))  # the bridge has taken them
    announce("left")


def show_publishers(topic: str) -> None:
    """Print the QoS of a topic's publishers whenever it changes."""
    with peer_node("watcher") as node:
        shown = [""]

        def look() -> bool:
            found = node.get_publishers_info_by_topic(topic)
            text = ", ".join(
                f"{p.qos_profile.reliability.name} {p.qos_profile.durability.name} "
                f"{p.qos_profile.deadline.nanoseconds} {p.topic_type_hash}"
                for p in found
            )
            if text != shown[0]:
                shown[0] = text
                announce(f"publishers: {text or 'none'}")
            return False

        announce("publishers: none")
        spin_until(node, look, 1e6)


def test_the_demo_is_heard_inside_and_outside(start, platform) -> None:
    run = start(forked_manycore("run", TALKER_LISTENER))
    outside = start(forked_example("listener"), **OUTSIDE)
    echo = start(forked_manycore("topic", "echo", "--outside", "/chatter"))
    run.wait_for(rf"^listener +\| .*{HEARD}")
    outside.wait_for(HEARD)
    echo.wait_for(r"^data: '?Hello World: \d+'?$")
    run.skip_output()
    numbers = [int(run.wait_for(rf"^listener .*{HEARD}: (\d+)").group(1)) for _ in range(4)]
    assert numbers == list(range(numbers[0], numbers[0] + 4))  # each once: no echo
    assert run.stop() == 0
    assert leftovers(platform) == []


def test_a_talker_outside_is_heard_inside(bridge) -> None:
    bridge.run(bridge.route("inward", "/news"))
    bridge.outside(say, "/news", DEEP, 0.05)
    hearer = bridge.inside(hear, "/news", DEEP)
    first, second = (hearer.wait_for(r"^heard again (\d+) (\d+)$") for _ in range(2))
    said_ns, stamp_ns = map(int, first.groups())
    assert said_ns <= stamp_ns <= int(second.group(1))  # the source timestamp is the talker's
    wait_until(lambda: bridge.row("inward", "/news")["messages"], "what was heard is counted")
    row = bridge.row("inward", "/news")
    assert row["lost"] == row["refused"] == row["too_fast"] == 0


def test_names_may_differ_outside(bridge) -> None:
    bridge.run(bridge.route("outward", "/a", outside="/robot/a"))
    bridge.inside(say, "/a", {}, 0.05)
    bridge.outside(hear, "/robot/a", {}).wait_for("^heard again")


@pytest.mark.parametrize("direction", ["inward", "outward"])
def test_a_late_subscriber_gets_what_was_latched(bridge, direction) -> None:
    latched = {"durability": "transient_local", "depth": 1}
    bridge.run(bridge.route(direction, "/map"))
    source, target = bridge.outside, bridge.inside
    if direction == "outward":
        source, target = target, source
    source(say, "/map", latched, None, "the map").wait_for("^said$")
    target(hear, "/map", latched).wait_for("^heard the map")
    target(hear, "/map", latched).wait_for("^heard the map")  # a second, even later one


def test_the_outside_publisher_offers_what_the_inside_one_does(bridge) -> None:
    bridge.run(bridge.route("outward", "/scan"))
    watcher = bridge.outside(show_publishers, "/scan")
    watcher.wait_for("^publishers: none$")
    speaker = bridge.inside(say, "/scan", {"reliability": "best_effort"}, 0.1)
    watcher.wait_for("^publishers: BEST_EFFORT VOLATILE .*RIHS01_[0-9a-f]{64}")
    speaker.stop()
    watcher.wait_for("^publishers: none$")
    bridge.inside(say, "/scan", {"durability": "transient_local"}, 0.1)
    watcher.wait_for("^publishers: RELIABLE TRANSIENT_LOCAL")


@pytest.mark.parametrize("direction", ["inward", "outward"])
def test_the_last_message_is_received(bridge, direction) -> None:
    """A publisher that ends does not take back messages that the bridge has not taken yet."""
    bridge.run(bridge.route(direction, "/news"))
    source, target = bridge.outside, bridge.inside
    if direction == "outward":
        source, target = target, source
    hearer = target(hear, "/news", {"depth": MANY})
    speaker = source(say_much_and_leave, "/news", MANY)
    hearer.wait_for("^heard again")
    speaker.signal(signal.SIGUSR1)
    speaker.wait_for("^left$")
    wait_until(lambda: bridge.row(direction, "/news")["state"] == "waiting", "the route is left")
    hearer.wait_for(f"^heard {MANY - 1} ")
    numbers = re.findall(r"^heard (\d+) ", hearer.output, re.MULTILINE)
    assert [int(number) for number in numbers] == list(range(MANY))


def test_a_slow_subscriber_receives_the_last_message(bridge) -> None:
    bridge.run(bridge.route("outward", "/news"))
    hearer = bridge.outside(hear, "/news", {"depth": MANY})
    speaker = bridge.inside(say_much_and_leave, "/news", MANY)
    hearer.wait_for("^heard again")
    hearer.signal(signal.SIGSTOP)
    speaker.signal(signal.SIGUSR1)
    speaker.wait_for("^left$")
    wait_until(lambda: bridge.row("outward", "/news")["state"] == "waiting", "the route is left")
    later_s = time.monotonic() + 2
    wait_until(lambda: time.monotonic() > later_s, "the bridge had time to lose patience")
    hearer.signal(signal.SIGCONT)
    hearer.wait_for(f"^heard {MANY - 1} ")


def test_a_killed_publisher_takes_the_bridges_with_it(bridge) -> None:
    bridge.run(bridge.route("inward", "/scan"))
    watcher = bridge.inside(show_publishers, "/scan")
    speaker = bridge.outside(say, "/scan", {"reliability": "best_effort"}, 0.1)
    watcher.wait_for("^publishers: BEST_EFFORT VOLATILE")
    speaker.stop()
    watcher.wait_for("^publishers: none$")


def test_no_subscriber_outside_means_no_work(bridge) -> None:
    bridge.run(bridge.route("outward", "/busy"))
    bridge.inside(say, "/busy", {}, 0.01)
    wait_until(lambda: bridge.row("outward", "/busy").get("state") == "ready", "the route is up")
    hearer = bridge.outside(hear, "/busy", {})
    hearer.wait_for("^heard again")
    assert bridge.row("outward", "/busy")["state"] == "forwarding"
    hearer.stop()
    wait_until(lambda: bridge.row("outward", "/busy")["state"] == "ready", "the bridge rests")


def test_both_directions_make_no_echo(bridge) -> None:
    bridge.run(bridge.route("inward", "/chat"), bridge.route("outward", "/chat"))
    inside, outside = (side(hear, "/chat", {}) for side in (bridge.inside, bridge.outside))
    bridge.inside(say, "/chat", {}, 0.05)
    bridge.outside(say, "/chat", {}, 0.05)
    for side in (inside, outside):
        side.wait_for("^heard again")
    # The bridge receives its own messages, and does not forward them.
    wait_until(lambda: bridge.row("inward", "/chat").get("own", 0) > 10, "own messages outside")
    wait_until(lambda: bridge.row("outward", "/chat").get("own", 0) > 10, "own messages inside")
    for side in (inside, outside):
        times = re.findall(r"^heard again (\d+) ", side.output, re.MULTILINE)
        assert len(times) == len(set(times))


def test_rate_and_size_limits_count_what_they_keep(bridge) -> None:
    bridge.run(
        bridge.route("outward", "/fast", max_hz=5),
        bridge.route("outward", "/large", max_size=100),
    )
    bridge.inside(say, "/fast", {}, 0.01)
    bridge.inside(say, "/large", {"durability": "transient_local", "depth": 1000}, 0.05, "x" * 200)
    hearers = [bridge.outside(hear, name, {}) for name in ("/fast", "/large")]
    for hearer in hearers:
        hearer.wait_for("^heard again")
    since_s, before = time.monotonic(), bridge.row("outward", "/fast")
    too_many = before["too_fast"] + 200
    wait_until(lambda: bridge.row("outward", "/fast")["too_fast"] > too_many, "many were too fast")
    passed = bridge.row("outward", "/fast")["messages"] - before["messages"]
    assert passed <= 2 + 5 * (time.monotonic() - since_s)  # the first two at once
    assert bridge.row("outward", "/large")["too_large"] == 1


def test_a_type_that_is_not_installed_is_reported(bridge) -> None:
    routes = bridge.run(
        bridge.route("outward", "/odd", "no_such_msgs/msg/Thing"), bridge.route("outward", "/ok")
    )
    routes["outward"].wait_for("^/odd: type no_such_msgs/msg/Thing is not installed")
    assert bridge.row("outward", "/odd")["state"] == "failed"
    bridge.inside(say, "/ok", {}, 0.05)
    bridge.outside(hear, "/ok", {}).wait_for("^heard again")


def test_a_route_that_cannot_be_made_is_reported(bridge) -> None:
    routes = bridge.run(
        bridge.route("outward", "/odd", "std_srvs/srv/SetBool", outside="/no name"),
        bridge.route("outward", "/slow", max_hz=1e-320),
        bridge.route("outward", "/count", "test_msgs/action/Nothing_FeedbackMessage"),
        bridge.route("outward", "/ok"),
    )
    routes["outward"].wait_for("^/slow: OverflowError")
    routes["outward"].wait_for("^/odd: .*Invalid service name.* '/no name'")
    routes["outward"].wait_for("^/count: .*Nothing")
    for name in ("/odd", "/slow", "/count"):
        assert bridge.row("outward", name)["state"] == "failed"
    bridge.inside(say, "/ok", {}, 0.05)
    bridge.outside(hear, "/ok", {}).wait_for("^heard again")


@pytest.mark.parametrize("direction", ["inward", "outward"])
def test_a_policy_that_cannot_match_is_reported(bridge, direction) -> None:
    processes = bridge.run(bridge.route(direction, "/odd", qos={"reliability": "reliable"}))
    source = bridge.outside if direction == "inward" else bridge.inside
    source(say, "/odd", {"reliability": "best_effort"}, 0.05)
    processes[direction].wait_for(
        "^/odd: its qos requests reliability reliable, the publisher offers best_effort$"
    )


@pytest.mark.parametrize("direction", ["inward", "outward"])
def test_a_type_that_does_not_fit_is_reported_once(bridge, direction) -> None:
    process = bridge.run(bridge.route(direction, "/odd", "std_msgs/msg/Int32"))[direction]
    source = bridge.outside if direction == "inward" else bridge.inside
    speaker = source(say, "/odd", {}, 0.05)
    where = "outside" if direction == "inward" else "inside"
    said = f"^/odd: is std_msgs/msg/String {where}, not std_msgs/msg/Int32$"
    process.wait_for(said)
    for _ in range(3):  # the graphs change; the reason stays the same
        with_it = source(say, f"/{direction}", {}, 0.05)
        with_it.wait_for("^said$")
        with_it.stop()
    assert bridge.row(direction, "/odd")["state"] == "failed"
    speaker.stop()
    wait_until(lambda: bridge.row(direction, "/odd")["state"] == "waiting", "the route waits")
    assert len(re.findall(said, process.output, re.MULTILINE)) == 1
