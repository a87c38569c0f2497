# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Images as the page shows them."""

from __future__ import annotations

from base64 import b64decode
from typing import Any

import numpy as np
import pytest
from sensor_msgs.msg import CompressedImage, Image

from rmw_manycore_py.cli.topic.samples import image_of

pytestmark = pytest.mark.unit


def image(encoding: str, rows: Any, *, padding: int = 0, big: bool = False) -> Image:
    """Return an image; rows of pixels, or of pixels of channels."""
    data = np.array(rows)
    height, width = data.shape[:2]
    lines = [row.tobytes() + bytes(padding) for row in data]
    return Image(
        encoding=encoding,
        height=height,
        width=width,
        step=len(lines[0]),
        is_bigendian=int(big),
        data=b"".join(lines),
    )


def colours_of(message: Any) -> list[list[int]]:
    found = image_of(message)
    assert found is not None
    data = np.frombuffer(b64decode(found["rgba"]), np.uint8).reshape(-1, 4)
    assert found["width"] * found["height"] == len(data)
    return [list(map(int, pixel)) for pixel in data]


BYTES = [[[1, 2, 3], [4, 5, 6]]]


def test_colours_are_red_green_and_blue() -> None:
    rows = np.array(BYTES, np.uint8)
    assert colours_of(image("rgb8", rows, padding=3)) == [[1, 2, 3, 255], [4, 5, 6, 255]]
    assert colours_of(image("bgr8", rows)) == [[3, 2, 1, 255], [6, 5, 4, 255]]
    four = np.array([[[1, 2, 3, 9]]], np.uint8)
    assert colours_of(image("bgra8", four)) == [[3, 2, 1, 255]]


@pytest.mark.parametrize(
    ("encoding", "kind", "big"),
    [("mono16", "<u2", False), ("16UC1", ">u2", True), ("32FC1", "<f4", False)],
)
def test_depths_are_scaled_to_grey(encoding: str, kind: str, big: bool) -> None:
    rows = np.array([[500, 1000], [750, 500]], kind)
    grey = [pixel[0] for pixel in colours_of(image(encoding, rows, big=big))]
    assert grey == [0, 255, 127, 0]


def test_what_is_not_finite_is_black() -> None:
    rows = np.array([[np.nan, np.inf], [1.0, 2.0]], "<f4")
    assert [pixel[0] for pixel in colours_of(image("32FC1", rows))] == [0, 0, 0, 255]


def test_large_images_are_thinned() -> None:
    found = image_of(image("mono8", np.zeros((480, 1000), np.uint8)))
    assert found is not None
    assert (found["width"], found["height"]) == (250, 120)


def test_compressed_images_are_left_to_the_browser() -> None:
    found = image_of(CompressedImage(format="rgb8; png compressed", data=b"\x01"))
    assert found == {"url": "data:image/png;base64,AQ=="}


def test_images_that_are_not_whole_are_not_drawn() -> None:
    short = image("rgb8", np.array(BYTES, np.uint8))
    short.data = short.data[:-1]
    assert image_of(short) is None
    assert image_of(Image(encoding="rgb8")) is None
    assert image_of(image("bayer_rggb8", np.zeros((2, 2), np.uint8))) is None
    narrow = image("rgb8", np.array(BYTES, np.uint8))
    narrow.step = 1
    assert image_of(narrow) is None


def test_a_message_with_fields_of_an_image_but_other_types_is_none() -> None:
    class Text:
        format, data = "plain", "no bytes"

        @staticmethod
        def get_fields_and_field_types() -> dict[str, str]:
            return {"format": "string", "data": "string"}

    assert image_of(Text()) is None
