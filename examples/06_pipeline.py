# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A pipeline of three numpy programs, placed on cores of two clusters by a mapfile.

    python examples/06_pipeline.py

    camera (cluster 1) -- /image --> edges (cluster 2) -- /edges --> display (cluster 2)

Without an argument this program runs 06_pipeline.yaml, which starts it three times more with the
name of a stage. Stages read images of 256 KiB in place. `manycore top` and `manycore view` show
them like any node.
"""

import sys
from pathlib import Path

import numpy as np

import rmw_manycore_py as manycore
from rmw_manycore_py import transport

MAPFILE = Path(__file__).with_suffix(".yaml")
IMAGES = 30
# No image is overwritten before it was taken.
QOS = transport.Qos(history="keep_all")


def camera() -> None:
    """Publish images of a bright square that moves."""
    with transport.join(name="camera") as member:
        publisher = member.publisher("/image", np.uint8, qos=QOS)
        publisher.wait_for_subscriptions()
        for number in range(IMAGES):
            image = np.zeros((512, 512), np.uint8)
            image[10 * number : 10 * number + 100, 200:300] = 255
            publisher.publish(image)


def edges() -> None:
    """Publish where the brightness of each image changes from column to column."""
    with transport.join(name="edges") as member:
        images = member.subscription("/image", np.uint8, qos=QOS)
        publisher = member.publisher("/edges", np.uint8, qos=QOS)
        publisher.wait_for_subscriptions()
        for _, message in zip(range(IMAGES), images, strict=False):
            left, right = message.array[:, :-1], message.array[:, 1:]
            publisher.publish((left != right).view(np.uint8))
            del left, right  # views of the message must not outlive it


def display() -> None:
    """Print where the edges are."""
    with transport.join(name="display") as member:
        found = member.subscription("/edges", np.uint8, qos=QOS)
        for _, message in zip(range(IMAGES), found, strict=False):
            rows, columns = np.nonzero(message.array)
            print(f"image {message.sequence}: rows {rows.min()} to {rows.max()}", end=", ")
            print(f"columns {np.unique(columns)}")


def main() -> int:
    """Run all stages until the last image was shown; return the exit status."""
    with manycore.run(MAPFILE, on_output=lambda node, line: print(f"{node} | {line}")) as active:
        return active.wait() or 0


if __name__ == "__main__":
    if len(sys.argv) == 1:
        sys.exit(main())
    {"camera": camera, "edges": edges, "display": display}[sys.argv[1]]()
