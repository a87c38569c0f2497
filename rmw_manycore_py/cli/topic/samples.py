# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Program of `manycore view`: the newest messages of a topic, as lines of JSON.

Arguments: platform, topic. Of a fast topic only some are printed, but always the last one.
"""

from __future__ import annotations

import sys
import time
from base64 import b64encode
from typing import Any

import numpy as np

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.message_text import Shown, to_plain
from rmw_manycore_py.cli.common.printing import json_text
from rmw_manycore_py.cli.topic.cloud_samples import cloud_of, is_cloud
from rmw_manycore_py.cli.topic.listening import Listener
from rmw_manycore_py.cli.topic.qos_options import QosOptions
from rmw_manycore_py.cli.topic.surroundings import Surroundings
from rmw_manycore_py.errors import ManycoreError

_PERIOD_S = 0.2
_SHOWN = Shown(length=12)  # elements of arrays; strings are cut likewise
_MAX_SIDE = 320  # pixels of an image
_MAX_COMPRESSED_BYTES = 1 << 20
# Fields of sensor_msgs/msg/CompressedImage and Image that are needed, and of other messages like
# them.
_COMPRESSED = {"format": "string", "data": "sequence<uint8>"}
_RAW = {
    "encoding": "string",
    "is_bigendian": "uint8",
    **dict.fromkeys(("height", "width", "step"), "uint32"),
    "data": "sequence<uint8>",
}
# Channels of an encoding that make red, green and blue; see sensor_msgs/image_encodings.hpp.
_CHANNELS = {"rgb8": (0, 1, 2), "bgr8": (2, 1, 0), "rgba8": (0, 1, 2), "bgra8": (2, 1, 0)}
_GREY = {"mono8": "u1", "8UC1": "u1", "mono16": "u2", "16UC1": "u2", "32FC1": "f4"}


def main() -> None:
    """Print messages until interrupted; errors go to standard error."""
    platform, topic = sys.argv[1:]
    newest: Any = None  # that is not shown yet
    surroundings: Surroundings | None = None  # of clouds

    def heard(message: Any) -> None:
        nonlocal newest
        newest = message

    def show_newest() -> None:
        nonlocal newest
        message, newest = newest, None
        if message is None:
            return
        row = {"time_s": time.time(), "fields": to_plain(message, _SHOWN)}
        if surroundings is not None:
            _show({**row, "cloud": cloud_of(message)})
            surroundings.belong_to(message.header.frame_id)
        else:
            _show({**row, "image": image_of(message)})

    try:
        listener = Listener(platform, topic, None, heard, qos=QosOptions(depth=1))
        listener.every(_PERIOD_S, show_newest)
        with view.open_platform(platform) as opened:
            if is_cloud(listener.message_type()):
                surroundings = Surroundings(listener, opened, topic, _show)
            listener.run()
    except ManycoreError as error:
        sys.exit(f"manycore: {error}")


def _show(row: dict[str, Any]) -> None:
    print(json_text(row), flush=True)


def image_of(message: Any) -> dict[str, Any] | None:
    """Return a small copy of an image: width, height and RGBA in base64, or a URL of its data."""
    fields = message.get_fields_and_field_types()
    if _COMPRESSED.items() <= fields.items() and len(message.data) <= _MAX_COMPRESSED_BYTES:
        kind = "png" if "png" in message.format else "jpeg"
        return {"url": f"data:image/{kind};base64,{b64encode(bytes(message.data)).decode()}"}
    if not _RAW.items() <= fields.items():
        return None
    pixels = _pixels(message)
    if pixels is None:
        return None
    every = max(-(-max(pixels.shape[:2]) // _MAX_SIDE), 1)
    small = pixels[::every, ::every]
    opaque = np.full((*small.shape[:2], 1), 255, np.uint8)
    rgba = np.concatenate([small, opaque], axis=2)
    return {
        "width": small.shape[1],
        "height": small.shape[0],
        "rgba": b64encode(rgba.tobytes()).decode(),
    }


def _pixels(message: Any) -> Any:
    """Return the colours of an image, or None if its encoding or size is none of ours."""
    channels, grey = _CHANNELS.get(message.encoding), _GREY.get(message.encoding)
    count = len(message.encoding) - 1 if channels else 1
    kind = np.dtype(grey or "u1").newbyteorder(">" if message.is_bigendian else "<")
    size, row_bytes = message.height * message.step, message.width * count * kind.itemsize
    is_whole = size and row_bytes <= message.step and len(message.data) >= size
    if not is_whole or (channels is None and grey is None):
        return None
    data = np.frombuffer(memoryview(message.data).cast("B")[:size], np.uint8)
    rows = data.reshape(message.height, message.step)[:, :row_bytes]
    values = np.ascontiguousarray(rows).view(kind).reshape(message.height, message.width, count)
    if channels is not None:
        return values[:, :, channels]
    return np.repeat(_as_bytes(values), 3, axis=2)


def _as_bytes(values: Any) -> Any:
    """Scale to 0..255, unless they are bytes already; what is not finite is black."""
    if values.dtype == np.uint8:
        return values
    known = values[np.isfinite(values)]
    low, high = (known.min(), known.max()) if known.size else (0.0, 1.0)
    scaled = (values.astype(np.float64) - low) * (255 / max(float(high) - float(low), 1e-9))
    return np.nan_to_num(scaled, nan=0.0, posinf=0.0, neginf=0.0).astype(np.uint8)


if __name__ == "__main__":
    main()
