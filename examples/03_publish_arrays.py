# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publish numpy arrays without ROS: a process that joins a platform, publishes and leaves.

    python examples/03_publish_arrays.py [COUNT]

It waits until a subscription is there, such as that of 04_take_arrays.py in another terminal.
`manycore topic echo /points` shows the arrays too, and ROS 2 nodes may subscribe to them.
"""

import sys

import numpy as np

from rmw_manycore_py import transport


def main(count: int) -> None:
    """Publish `count` clouds of 1,000 points, the last of them empty."""
    generator = np.random.default_rng(1)
    with transport.join() as member:
        publisher = member.publisher("/points", np.float32, qos=transport.Qos(depth=count))
        publisher.wait_for_subscriptions()
        for number in range(1, count):
            points = generator.normal(loc=number, size=(1000, 3)).astype(np.float32)
            publisher.publish(points)
        publisher.publish(np.zeros((0, 3), np.float32))
    print(f"published {count} clouds in cluster {member.cluster} of {member.platform}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10)
