# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The picture that the image pipeline sends: 1 MiB of which every byte can be checked.

Pixel (row, column) of frame n is (n + row) mod 256, so a picture made of parts of two frames, or
with a shifted part, differs from every whole one.
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
    """Return a mono8 image whose `frame_id` carries the frame's number."""
    image = Image(height=SIDE_PIXELS, width=SIDE_PIXELS, step=SIDE_PIXELS, encoding="mono8")
    image.header.frame_id = str(number)
    image.data.frombytes(pixels.tobytes())
    return image
