# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The transfers of ROS-lite between two processes: messages, a session, and a segment per message.

    python examples/07_transfers.py

Without an argument this program starts itself once more, as the receiving process. The commands
wait in the kernel until the images were received; then the most urgent one comes first.
"""

import subprocess
import sys

import numpy as np

from rmw_manycore_py import emcos

IMAGE_SHAPE = (480, 640)
IMAGE_BYTES = 480 * 640
IMAGES = 3


def send() -> None:
    """Send commands, images and a map."""
    with emcos.MessageSender("commands") as commands:
        commands.send(b"slow down")
        commands.send(b"stop", priority=7)
        with emcos.SessionSender("images", IMAGE_BYTES) as session:
            for number in range(1, IMAGES + 1):
                session.buffer[:] = number
                session.send()  # a thread copies it to the other side
                session.wait()  # until then, the buffer must not be written again
    with emcos.SegmentWriter("map") as writer:
        writer.put(np.arange(1_000_000, dtype=np.float32))


def receive() -> None:
    """Print what comes."""
    with emcos.MessageReceiver("commands") as commands:
        with emcos.SessionReceiver("images", IMAGE_BYTES) as session:
            for buffer in session:  # this side's until the next turn
                image = buffer.reshape(IMAGE_SHAPE)
                print(f"image: {image.shape}, mean {image.mean()}")
        for message in commands:
            print(f"command of priority {message.priority}: {message.data.decode()}")
    with emcos.SegmentReader("map") as reader:
        points = reader.take().view(np.float32)  # without a copy; freed with the array
        print(f"map: {points.size} points, the last one {points[-1]}")


def main() -> int:
    """Send to a process of its own; return its exit status."""
    with subprocess.Popen([sys.executable, __file__, "receive"]) as receiver:
        send()
        return receiver.wait()


if __name__ == "__main__":
    if len(sys.argv) == 1:
        sys.exit(main())
    receive()
