# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore view`: its HTTP requests, and the snapshots that it serves."""

from __future__ import annotations

import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
import xml.etree.ElementTree as ElementTree
from contextlib import closing

import pytest

from rmw_manycore_py.bench.idle import wait_until_quiet, wake_ups
from rmw_manycore_py.platform.monitor.watch import Watch
from rmw_manycore_py.view.client_user import user_of_client
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.peers.programs import forked_example, forked_manycore
from support.processes.platforms import PLATFORMS, leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]


# A node that uses its two workers 20 times a second.
MATCHER = """
import os
import rclpy
from support.samples.ndt_world import pose, scan_at, street
from rmw_manycore_py.ndt import MatcherOptions, VoxelMap, WorkerMatcher

rclpy.init()
node = rclpy.create_node("matcher")
options, place = MatcherOptions(), pose(40, 0.5, 1.8, 0.01, -0.02, 0.3)
world = street()
scan = scan_at(world, place)
with WorkerMatcher(options, [min(os.sched_getaffinity(0))] * 2) as matcher:
    matcher.set_map(VoxelMap.from_points(world, options))
    print("matching", flush=True)
    while True:
        rclpy.spin_once(node, timeout_sec=0.05)
        matcher.score(scan, place)
"""


def answer(link: str, method: str = "GET", **headers: str) -> tuple[int, str]:
    """Return status and body of a request."""
    named = {name.replace("_", "-"): value for name, value in headers.items()}
    request = urllib.request.Request(link, method=method, headers=named)
    try:
        with urllib.request.urlopen(request) as response:
            return response.status, response.read().decode()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read().decode()


def test_only_its_own_page_is_answered(view) -> None:
    _, link = view
    origin = link.rsplit("/", 2)[0]
    assert answer(link)[0] == 200
    assert answer(origin + "/")[0] == 403
    status, text = answer(origin + "/wrong/")
    assert (status, "wrong token" in text) == (403, True)
    assert answer(link, Host="elsewhere.example")[0] == 403
    assert answer(link, Origin="http://elsewhere.example")[0] == 403
    assert answer(link + "trace/start", "POST")[0] == 403
    assert answer(link + "live", Upgrade="websocket")[0] == 403


def test_actions_wait_for_the_platform(view, platform) -> None:
    _, link = view
    origin = link.rsplit("/", 2)[0]
    for action in ("trace/start", "trace/stop", "parameters?node=/x"):
        status, text = answer(link + action, "POST", Origin=origin)
        waiting = f"waiting for platform {platform} to start"
        assert (status, json.loads(text)) == (409, {"error": waiting})


def test_only_files_of_the_page_are_answered(view) -> None:
    _, link = view
    assert answer(link + "page/main.js")[0] == 200
    for path in ("../server.py", "%2e%2e/server.py", "..%2fserver.py"):
        assert answer(link + f"page/{path}")[0] == 404
    assert answer(link + "trace/..%2f..%2fetc%2fpasswd")[0] == 404


@pytest.mark.needs("setpriv", "curl")
@pytest.mark.skipif(os.geteuid() != 0, reason="needs another user")
def test_another_user_with_the_link_is_refused(view) -> None:
    """With `--open` it is an argument of the browser, which `ps` shows to all users."""
    link = view[1]
    origin = link.rsplit("/", 2)[0]
    other = ["setpriv", "--reuid=12345", "--regid=12345", "--clear-groups"]
    curl = ["curl", "-s", "-w", "%{http_code}"]
    for words in ([link], ["-X", "POST", "-H", f"Origin: {origin}", f"{link}trace/start"]):
        refused = subprocess.run(
            [*other, *curl, *words], capture_output=True, text=True, timeout=TIMEOUT_S
        )
        assert refused.stdout == "manycore view answers to the user who started it only403"
    assert answer(link)[0] == 200


def test_a_request_without_its_sender_is_refused(talking, view, platform, start) -> None:
    """The kernel forgets whose socket it was; while the server is stopped, the sender leaves."""
    program, link = view
    host, port = link.split("/")[2].split(":")
    wait_until(lambda: answer(link + "chip.svg")[0] == 200, "a trace could be started")
    os.kill(program.pid, signal.SIGSTOP)
    with socket.create_connection((host, int(port))) as client:
        origin, path = f"http://{host}:{port}", f"/{link.split('/', 3)[3]}trace/start"
        client.sendall(
            f"POST {path} HTTP/1.1\r\nHost: {host}:{port}\r\nOrigin: {origin}\r\n\r\n".encode()
        )
        here = client.getsockname()
    there = (host, int(port))
    assert user_of_client(here, there) is None
    os.kill(program.pid, signal.SIGCONT)
    assert answer(link)[0] == 200
    status = start(forked_manycore("trace", "status", "--platform", platform, "--json"))
    assert status.wait() == 0, status
    assert not json.loads(status.output)["on"], status


def test_the_user_of_a_connection_is_known(view) -> None:
    host, port = view[1].split("/")[2].split(":")
    for family, address in ((socket.AF_INET, host), (socket.AF_INET6, f"::ffff:{host}")):
        with socket.socket(family) as client:
            client.connect((address, int(port)))
            here = (host, client.getsockname()[1])
            assert user_of_client(here, (host, int(port))) == os.geteuid()


def test_a_port_in_use_is_named(view, start) -> None:
    port = view[1].split(":")[2].split("/")[0]
    second = start(forked_manycore("view", "--port", port))
    assert second.wait() == 1
    assert f"port {port} is in use" in second.output
    assert "--port" in second.output


def test_the_picture_is_drawn_without_a_browser(talking, start, tmp_path) -> None:
    file = tmp_path / "chip.svg"
    drawn = start(forked_manycore("view", "--once", "-o", str(file)))
    assert drawn.wait() == 0, drawn
    text = "".join(ElementTree.parse(file).getroot().itertext())
    for part in ("/talker", "/listener", "/chatter", "core 3", "cluster 2", "receive thread"):
        assert part in text


def test_looking_wakes_no_node_and_joins_nothing(start, platform) -> None:
    listener = start(forked_example("listener"))
    watch = Watch(platform)
    wait_until(lambda: (look := watch.look()) and look.graph.endpoints, "it is there")
    wait_until_quiet([listener.pid])

    def sleeps_while_looked_at() -> bool:
        before = wake_ups([listener.pid])
        for _ in range(50):
            watch.look()
        return wake_ups([listener.pid]) == before

    # Its receive thread may have been slow, and wake it once when it starts.
    wait_until(sleeps_while_looked_at, "looks wake no node")
    assert [member.pid for member in watch.look().graph.members] == [listener.pid]
    watch.close()


def test_a_death_differs_from_a_leave(talking, platform, start) -> None:
    talker, listener = talking
    watch = Watch(platform)
    assert watch.look().dead == ()
    talker.signal(signal.SIGKILL)
    looks = []
    wait_until(lambda: looks.append(watch.look()) or looks[-1].dead, "the death is seen")
    deaths = [event for look in looks for event in look.happened if event.kind == "died"]
    assert deaths == [event for event in looks[-1].happened if event.kind == "died"]
    assert len(deaths) == 1
    assert [member.pid for member in looks[-1].dead] == [talker.pid]  # in the same look
    # A new interpreter: a fork ends without the interpreter's clean-up and would not leave.
    again = start(forked_example("talker"))
    wait_until(lambda: not watch.look().dead, "it runs again")
    again.wait_for("Publishing")
    assert again.stop_node()
    wait_until(lambda: len(watch.look().graph.members) == 1, "it has left")
    assert watch.look().dead == ()
    os.kill(listener.pid, signal.SIGKILL)
    told = []

    def has_ended() -> bool:
        look = watch.look()
        told.extend(watch.last_words if look is None else look.happened)
        return look is None

    wait_until(has_ended, "the platform has ended")
    assert [one.text.split(" (")[0] for one in told if one.kind in ("died", "platform")] == [
        "/listener died",
        f"platform {platform} has ended",
    ]
    wait_until(lambda: not leftovers(platform), "nothing is left")


def test_a_platform_that_is_half_removed_has_ended(start, platform) -> None:
    start(forked_example("listener"))
    with closing(Watch(platform)) as watch, closing(Watch(platform)) as late:
        wait_until(lambda: (look := watch.look()) and look.graph.endpoints, "the node is there")
        (PLATFORMS / platform / "cluster-1.pipe").unlink()
        assert watch.look() is None
        assert [one.text for one in watch.last_words] == [f"platform {platform} has ended"]
        assert late.look() is None
        assert late.last_words == ()
    shutil.rmtree(PLATFORMS / platform)


# A node that publishes 30 messages within 0.3 s.
BURST = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("burst")
publisher = node.create_publisher(String, "words", 100)
while publisher.get_subscription_count() == 0:
    rclpy.spin_once(node, timeout_sec=0.05)
words = iter([f"word {number}." for number in range(30)])

def publish():
    if word := next(words, None):
        publisher.publish(String(data=word))

node.create_timer(0.01, publish)
rclpy.spin(node)
"""


def test_the_last_message_of_a_burst_is_shown(start, platform) -> None:
    start([sys.executable, "-c", BURST])
    with closing(Watch(platform)) as watch:
        wait_until(lambda: (look := watch.look()) and "/words" in look.graph.topics, "the topic")
    program = [sys.executable, "-m", "rmw_manycore_py.cli.topic.samples", platform, "/words"]
    start(program).wait_for(r"word 29\.")


def test_a_worker_in_the_place_of_a_killed_one_is_seen(start, platform) -> None:
    matcher = start([sys.executable, "-c", MATCHER])
    matcher.wait_for("matching")
    with closing(Watch(platform)) as watch:
        before = watch.look().workers[matcher.pid]
        assert len(before) == 2
        os.kill(before[0], signal.SIGKILL)

        def is_replaced() -> bool:
            now = watch.look().workers.get(matcher.pid, ())
            return len(now) == 2 and before[0] not in now and before[1] in now

        wait_until(is_replaced, "the other worker is seen")
        look = watch.look()
        assert set(look.workers[matcher.pid]) <= look.loads.after.cpu_ns.keys()
    matcher.kill()
