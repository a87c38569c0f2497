# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Tools beside a run in virtual time show its time, and take no part in it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rmw_manycore_py.recording.recording import Recording
from support import IS_MANYCORE, wait_until
from support.nodes import timed
from support.peers.programs import forked_manycore

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
    pytest.mark.needs("mcap"),
]

START_NS = 10**18
PERIOD_NS = 10**8


def test_tools_show_virtual_time_and_do_not_disturb_it(
    start, manycore, timed_mapfile, tmp_path: Path
) -> None:
    run = start(
        forked_manycore("run", timed_mapfile(timed, "talker", "echo"), "--virtual", "--instant")
    )
    run.wait_for("echo 1 ")
    manycore("pause")
    looks = [json.loads(manycore("top", "--count", "1", "--json"))["virtual_s"] for _ in range(2)]
    assert looks[0] == looks[1] > 0.07
    bag = tmp_path / "bag.mcap"
    recorder = start(forked_manycore("topic", "record", "/chatter", "-o", bag))
    recorder.wait_for("^recording /chatter")
    rate = start(forked_manycore("topic", "hz", "/chatter", "--json"))
    wait_until(lambda: "count: 3" in manycore("topic", "info", "/chatter"), "tools listen")
    for _ in range(3):
        manycore("step", "--for", "0.5")
    rate.wait_for(r'"min_s": 0\.(1|0999999).*"max_s": 0\.(1|0999999)')
    assert recorder.stop() == 0
    with Recording(bag) as recording:
        times = [message.recorded_ns - START_NS for message in recording.messages({"/chatter"})]
    assert len(times) == 15
    assert times == [times[0] + number * PERIOD_NS for number in range(15)]
    assert times[0] % PERIOD_NS == 0
    assert run.stop() == 0
    heard = [line.split()[-2:] for line in run.output.splitlines() if "heard talker" in line]
    assert heard
    assert all(int(at_ns) % PERIOD_NS == 0 for times in heard for at_ns in times)
