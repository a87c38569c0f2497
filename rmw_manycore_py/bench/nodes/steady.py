# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishes serialized messages at a fixed rate, once there is a subscription.

Usage: steady TOPIC BYTES HZ COUNT.
"""

from __future__ import annotations

import json
import os
import struct
import sys
import time

from rmw_manycore_py.native._transport import Process, Qos

TYPE = "std_msgs/msg/UInt8MultiArray"
_LOOK_S = 0.01
# Serialized head of a message: CDR header, empty layout, its offset, size of the data.
_HEAD = struct.Struct("<BBHIII")


def main() -> None:
    """Publish; print the number of messages and bytes per second."""
    topic, *numbers = sys.argv[1:]
    size_bytes, rate_hz, count = map(int, numbers)
    data = _HEAD.pack(0, 1, 0, 0, 0, size_bytes) + bytes(size_bytes)
    with Process(os.environ["MANYCORE_PLATFORM"], label="steady") as process:
        publisher = process.publisher(topic, TYPE, Qos())
        while not publisher.matched():
            time.sleep(_LOOK_S)
        start_s = time.monotonic()
        for number in range(count):
            time.sleep(max(start_s + number / rate_hz - time.monotonic(), 0))
            publisher.publish(data)
        spent_s = time.monotonic() - start_s
        print(json.dumps({"sent": count, "bytes_per_s": count * len(data) / spent_s}))
        del publisher


if __name__ == "__main__":
    main()
