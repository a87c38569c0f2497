# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Nodes that print all they see with the time at which they see it: `timed.py NODE`."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path
from typing import Any

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_msgs.msg import String
from std_srvs.srv import Trigger

from rmw_manycore_py.native._transport import Process

KILLED_AT_S = 1.0
N_CALLS = 6
YEAR_2020_S = 1_577_836_800
BIRTHS = "BIRTHS"  # variable of the environment: the path of a file


class Timed(Node):
    """Base: prints."""

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self._number = 0

    def say(self, text: str) -> None:
        """Print with the time of all clocks that a node may ask."""
        print(text, self.get_clock().now().nanoseconds, time.time_ns(), flush=True)

    def hear(self, topic: str) -> None:
        """Print what is published on a topic."""
        self.create_subscription(String, topic, lambda heard: self.say(f"heard {heard.data}"), 10)

    def count(self) -> str:
        """Return the next number."""
        self._number += 1
        return f"{self.get_name()} {self._number}"


class Talker(Timed):
    """Publishes by a timer; hears its echo at the same time."""

    def __init__(self) -> None:
        super().__init__("talker")
        self.hear("echo")
        publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(0.1, lambda: publisher.publish(String(data=self.count())))


class Echo(Timed):
    """Publishes what it hears; its clock is that of simulations."""

    def __init__(self) -> None:
        super().__init__("echo", parameter_overrides=[Parameter("use_sim_time", value=True)])
        publisher = self.create_publisher(String, "echo", 10)
        self.create_subscription(String, "chatter", publisher.publish, 10)
        self.create_timer(0.07, lambda: self.say(self.count()))


class Server(Timed):
    """Comes up late, and answers late."""

    def __init__(self) -> None:
        time.sleep(0.3)
        super().__init__("server")
        self.create_service(Trigger, "ask", self._answer)

    def _answer(self, _: Any, answer: Any) -> Any:
        time.sleep(0.02)
        answer.message = self.count()
        return answer


class Asker(Timed):
    """Waits for the server, then asks it again and again."""

    def __init__(self) -> None:
        super().__init__("asker")
        self._client = self.create_client(Trigger, "ask")
        while not self._client.wait_for_service(timeout_sec=1.0):
            self.say("no server")
        self.say("server")
        self._ask()

    def _ask(self) -> None:
        self._client.call_async(Trigger.Request()).add_done_callback(self._hear)

    def _hear(self, future: Any) -> None:
        self.say(f"answer {future.result().message}")
        self._ask()


class Threads(Timed):
    """A callback blocks a thread of the executor until another thread's callback ran.

    It calls `N_CALLS` times: a thread that has no answer when the server stops waits for ever.
    """

    def __init__(self) -> None:
        super().__init__("threads")
        group = ReentrantCallbackGroup()
        self._client = self.create_client(Trigger, "ask", callback_group=group)
        self._client.wait_for_service()
        self._timer = self.create_timer(0.25, self._ask, callback_group=group)

    def _ask(self) -> None:
        self._number += 1
        if self._number == N_CALLS:
            self._timer.cancel()
        answer = self._client.call(Trigger.Request())
        self.say(answer.message)


class Mortal(Timed):
    """Kills itself at a fixed time, once in its life."""

    def __init__(self) -> None:
        super().__init__("mortal")
        self.hear("chatter")
        self.create_timer(KILLED_AT_S, lambda: os.kill(os.getpid(), signal.SIGKILL))
        self.say("born")


class Killer(Timed):
    """Kills the mortal node at a fixed time, and is not done before that lives again."""

    def __init__(self) -> None:
        super().__init__("killer")
        self.create_timer(KILLED_AT_S, self._kill)

    def _kill(self) -> None:
        victim = _last_born()
        os.kill(int(victim), signal.SIGKILL)
        while _last_born() in ("", victim):
            pass
        self.say("killed")


class Victim(Timed):
    """Leaves its process id to its killer."""

    def __init__(self) -> None:
        super().__init__("victim")
        self.create_timer(0.3, lambda: self.say(self.count()))
        self.say("born")


class Parent(Timed):
    """Has a child, which lives in wall time."""

    def __init__(self) -> None:
        super().__init__("parent")
        self.create_timer(1.0, self._fork)

    def _fork(self) -> None:
        child = os.fork()
        if child == 0:
            print("child", time.time() > YEAR_2020_S, flush=True)
            os._exit(0)
        os.waitpid(child, 0)


class Stayer(Timed):
    """Sleeps when virtual time is over."""

    def __init__(self) -> None:
        super().__init__("stayer")

    def destroy_node(self) -> None:
        """Sleep first."""
        begin_s = time.monotonic()
        time.sleep(0.1)
        print("slept", time.monotonic() - begin_s >= 0.1, flush=True)
        super().destroy_node()


class Camera(Timed):
    """Publishes when its timer's callback began."""

    def __init__(self) -> None:
        super().__init__("camera")
        self._publisher = self.create_publisher(String, "image", 10)
        self.create_timer(0.1, self._take)

    def _take(self) -> None:
        self._publisher.publish(String(data=str(self.get_clock().now().nanoseconds)))


class Filter(Timed):
    """Publishes what it hears."""

    def __init__(self) -> None:
        super().__init__("filter")
        publisher = self.create_publisher(String, "small", 10)
        self.create_subscription(String, "image", publisher.publish, 10)


class Sink(Timed):
    """Prints how long what it hears has taken, in us."""

    def __init__(self) -> None:
        super().__init__("sink")
        self.create_subscription(String, "small", self._hear, 10)

    def _hear(self, heard: String) -> None:
        print((self.get_clock().now().nanoseconds - int(heard.data)) / 1e3, flush=True)


class Ear(Timed):
    """Prints the news."""

    def __init__(self) -> None:
        super().__init__("ear")
        self.hear("news")


def _last_born() -> str:
    return Path(os.environ[BIRTHS]).read_text()


def wait_without_ros() -> None:
    """Wait on the platform as tools do, which know nothing of rclpy."""
    process = Process(os.environ["MANYCORE_PLATFORM"], label="tool")
    for _ in range(4):
        process.wait(process.epoch(), 0.25)
        print("tool", time.time_ns(), flush=True)


CLASSES = (
    *(Talker, Echo, Server, Asker, Threads, Mortal, Killer, Victim, Parent, Stayer),
    *(Camera, Filter, Sink, Ear),
)
KINDS = {kind.__name__.lower(): kind for kind in CLASSES}


def main() -> None:
    """Spin the node that the first argument names."""
    if sys.argv[1] == "tool":
        wait_without_ros()
        return
    if sys.argv[1] == "victim":  # before it joins
        Path(os.environ[BIRTHS]).write_text(str(os.getpid()))
    rclpy.init()
    node = None
    try:
        node = KINDS[sys.argv[1]]()
        executor = MultiThreadedExecutor(3) if isinstance(node, Threads) else None
        rclpy.spin(node, executor)
    except (KeyboardInterrupt, ExternalShutdownException):
        if isinstance(node, Stayer):
            node.destroy_node()


if __name__ == "__main__":
    main()
