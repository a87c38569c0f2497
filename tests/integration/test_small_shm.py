# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A /dev/shm that is too small gives an error that states the size needed."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from support import IS_MANYCORE, MAPFILES, TIMEOUT_S
from support.nodes.ros import announce
from support.processes.commands import example_command, manycore_command, peer_command
from support.processes.own_shm import can_mount, own_shm_command
from support.processes.platforms import environment, unique_platform
from support.processes.program import Program
from support.sources.advice import run_quoted

SIZE_NEEDED = re.compile(r"\b\d[\d,.]* ?(bytes|[KMG]iB)")


pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="about the segments of rmw_manycore"),
    pytest.mark.skipif(not can_mount(), reason="needs root and a mount namespace"),
]


@pytest.fixture
def start_small():
    programs = []

    def start_small(size_mib: int, command: list[str]) -> Program:
        env = environment(unique_platform())
        programs.append(Program(own_shm_command(size_mib, command), env))
        return programs[-1]

    yield start_small
    for program in programs:
        program.kill()


def assert_says_the_size(program: Program) -> None:
    status = program.wait()
    assert status > 0, program  # and not killed by a signal such as SIGBUS
    assert "/dev/shm" in program.output, program
    assert SIZE_NEEDED.search(program.output), program


def test_small_messages_fit(start_small):
    talker = start_small(16, example_command("talker"))
    talker.wait_for("Publishing")
    assert talker.stop_node(), talker


def test_a_mapfile_that_needs_more(start_small):
    """The clusters of image_pipeline have 4 MiB each."""
    mapfile = MAPFILES / "image_pipeline.yaml"
    assert_says_the_size(start_small(4, manycore_command("run", mapfile, "--duration", "5")))


PUBLISH_LARGE = """
import rclpy
from std_msgs.msg import UInt8MultiArray
rclpy.init()
node = rclpy.create_node("node")
publisher = node.create_publisher(UInt8MultiArray, "large", 10)
publisher.publish(UInt8MultiArray(data=bytes(32 << 20)))
"""


def test_a_message_that_needs_more(start_small):
    assert_says_the_size(start_small(16, [sys.executable, "-c", PUBLISH_LARGE]))


IMAGES = """
import subprocess, sys
from array import array
import rclpy
from sensor_msgs.msg import Image
from std_msgs.msg import UInt32

WIDTH, HEIGHT, COUNT = 1920, 1080, 20
rclpy.init()

def image_of(number):
    pixels = array("B", bytes([number]) * (WIDTH * HEIGHT * 3))
    return Image(width=WIDTH, height=HEIGHT, encoding="rgb8", data=pixels)

def subscriber():
    node = rclpy.create_node("subscriber")
    seen = node.create_publisher(UInt32, "seen", 10)
    def see(image):
        assert image == image_of(image.data[0])
        seen.publish(UInt32(data=image.data[0]))
    node.create_subscription(Image, "image", see, 10)
    rclpy.spin(node)

def publisher():
    node = rclpy.create_node("publisher")
    images, answers = node.create_publisher(Image, "image", 10), []
    node.create_subscription(UInt32, "seen", lambda answer: answers.append(answer.data), 10)
    reader = subprocess.Popen([sys.executable, "-c", sys.argv[1], sys.argv[1], "subscriber"])
    try:
        publish_all(node, images, answers)
    finally:
        reader.terminate()
        reader.wait()
    print("all images arrived")

def publish_all(node, images, answers):
    while images.get_subscription_count() == 0 or node.count_publishers("seen") == 0:
        rclpy.spin_once(node, timeout_sec=0.01)
    for number in range(1, COUNT + 1):  # one by one: each arrives
        images.publish(image_of(number))
        while answers[-1:] != [number]:
            rclpy.spin_once(node)
    assert answers == list(range(1, COUNT + 1)), answers
    for number in range(1, COUNT + 1):  # faster than the subscriber: the newest arrives
        images.publish(image_of(100 + number))
    while answers[-1] != 100 + COUNT:
        rclpy.spin_once(node)

subscriber() if sys.argv[2:] else publisher()
"""


def test_images_of_1080p(start_small):
    """The default /dev/shm of a container is enough for raw images with their history."""
    publisher = start_small(64, [sys.executable, "-c", IMAGES, IMAGES])
    assert publisher.wait(4 * TIMEOUT_S) == 0, publisher
    assert "all images arrived" in publisher.output, publisher


def enlarge_as_the_doctor_advises() -> None:
    def consult() -> str:
        return subprocess.run(manycore_command("doctor"), capture_output=True, text=True).stdout

    run_quoted(consult(), "mount -o remount")
    assert "`mount -o remount" not in consult()
    announce("cured")


def test_the_doctor_enlarges_it(start_small):
    start_small(16, peer_command(enlarge_as_the_doctor_advises)).wait_for("cured")


def test_hardly_any_room(start_small):
    # Some is left for the tracing library in the wheels of ROS, which dies without its page.
    fill = 'head -c 16300K /dev/zero > /dev/shm/full; exec "$@"'
    assert_says_the_size(start_small(16, ["sh", "-c", fill, "sh", *example_command("talker")]))
