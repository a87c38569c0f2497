# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What an idle link between two hosts costs, and what a break of it does to messages."""

from __future__ import annotations

import json
import subprocess
import time
from typing import Any

from rmw_manycore_bridge.status import status
from rmw_manycore_py.bench.hosts import CABLE, Host
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native._transport import Process, Qos

_PERIOD_S, _SETTLE_S, _TIMEOUT_S = 0.01, 1.0, 60.0
_TOPIC, _TYPE, _HEAD = "/beat", "std_msgs/msg/Int64", b"\0\1\0\0"


class Beat:
    """Numbers from the platform of one host to that of the other, sent by this process."""

    def __init__(self, here: str, there: str) -> None:
        self._platforms = here, there
        self._sender, self._receiver = (Process(name, label="beat") for name in self._platforms)
        self._publisher = self._sender.publisher(_TOPIC, _TYPE, Qos())
        self._subscription = self._receiver.subscription(_TOPIC, _TYPE, Qos(depth=1000))
        self._sent = self._heard = 0
        self._last = -1

    def until_heard(self) -> float:
        """Publish until a number that is published from now on arrives; return the seconds."""
        first, start_s = self._sent, time.monotonic()
        while self._last < first:
            if time.monotonic() > start_s + _TIMEOUT_S:
                raise ManycoreError(f"no message came within {_TIMEOUT_S:g} s")
            self._once()
        return time.monotonic() - start_s

    def for_a_while(self, seconds: float) -> None:
        """Publish at 100 Hz."""
        end_s = time.monotonic() + seconds
        while time.monotonic() < end_s:
            self._once()

    def uncounted(self) -> int:
        """Return how many messages were neither heard nor counted as lost."""
        time.sleep(_SETTLE_S)
        self._take()
        lost: int = sum(row["lost"] for name in self._platforms for row in _rows(name))
        return self._sent - self._heard - lost

    def close(self) -> None:
        """Leave both platforms."""
        for one in (self._publisher, self._subscription, self._sender, self._receiver):
            one.close()

    def _once(self) -> None:
        self._publisher.publish(_HEAD + self._sent.to_bytes(8, "little"))
        self._sent += 1
        time.sleep(_PERIOD_S)
        self._take()

    def _take(self) -> None:
        while claim := self._subscription.claim():
            self._last = int.from_bytes(claim.data[len(_HEAD) :], "little")
            claim.release()
            self._heard += 1


def _rows(platform: str) -> list[dict[str, Any]]:
    return [row for row in status(platform) if row["inside"] == _TOPIC]


def set_cable(host: Host, state: str) -> None:
    """Plug a host's end of the cable, `up` or `down`."""
    subprocess.run([*host, "ip", "link", "set", CABLE, state], check=True)


def traffic_bytes(host: Host) -> int:
    """Return what has crossed a host's end of the cable so far, both ways."""
    command = [*host, "ip", "-s", "-j", "link", "show", CABLE]
    found = subprocess.run(command, check=True, capture_output=True, text=True)
    counts = json.loads(found.stdout)[0]["stats64"]
    return int(counts["rx"]["bytes"] + counts["tx"]["bytes"])
