# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Test image of the image pipeline: 1 MiB, with every byte verifiable.

Pixel (row, column) of frame n is (n + row) mod 256, so an image composed of two frames, or with a
shifted part, differs from every valid one.
"""

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import Image

SIDE_PIXELS = 1024  # 1024 x 1024 x 1 byte = 1 MiB


def pixels_of_frame(number: int) -> NDArray[np.uint8]:
    """Return the pixels of a frame, row by row."""
    rows = (number + np.arange(SIDE_PIXELS)).astype(np.uint8)
    return np.repeat(rows, SIDE_PIXELS)


def make_image(number: int, pixels: NDArray[np.uint8]) -> Image:
    """Return a mono8 image with the frame number in `frame_id`."""
    image = Image(height=SIDE_PIXELS, width=SIDE_PIXELS, step=SIDE_PIXELS, encoding="mono8")
    image.header.frame_id = str(number)
    image.data.frombytes(pixels.tobytes())
    return image
