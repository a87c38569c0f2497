# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mapfiles that say how topics are transferred, with unmodified nodes."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.processes.platforms import leftovers

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore run is about rmw_manycore"),
]

TRANSFERS = {
    "transfer: message, priority: 5": "message, priority 5",
    "transfer: message, synchronous: true": "message, priority 0, synchronous",
    "transfer: session": "session",
    "transfer: async": "async",
}
LATE = "it is synchronous, and cluster 2 has not yet received the message after 100 ms"
RESTARTS = 20  # of the talker that publishes synchronously


def write_mapfile(directory: Path, transfer: str) -> Path:
    """Write a mapfile whose talker comes back.

    It ends when a synchronous message has not arrived within 100 ms, as on a machine that stands
    still for a moment.
    """
    retries = RESTARTS if "synchronous" in transfer else 0
    path = directory / "map.yaml"
    path.write_text(
        "platform: coolidge\n"
        f"topics: {{/chatter: {{topic_dsm_size: 64KiB, {transfer}}}}}\n"
        "nodes:\n"
        "  talker: {cluster: 1, core: 1, module: rmw_manycore_py.examples.talker,\n"
        f"    respawn: {{delay: 0, max_retries: {retries}}}}}\n"
        "  listener: {cluster: 2, core: 1, module: rmw_manycore_py.examples.listener}\n"
    )
    return path


@pytest.mark.parametrize("transfer", TRANSFERS)
def test_unmodified_nodes_talk(start, tmp_path, platform, transfer: str) -> None:
    trace = tmp_path / "trace.json"
    run = start(forked_manycore("run", write_mapfile(tmp_path, transfer), "--trace", trace))
    for _ in range(3):
        run.wait_for(r"^listener \| .*I heard: 'Hello World")
    status = start(forked_manycore("status", "--platform", platform))
    assert status.wait() == 0
    assert f"/chatter: transfer {TRANSFERS[transfer]}" in status.lines
    # The end may also meet a talker that is ending because a message has not arrived in time.
    assert run.stop() == 0 or ("synchronous" in transfer and LATE in run.output), run
    assert leftovers(platform) == []
    handed = traced(trace, "hand over /chatter")
    assert len(handed) >= 3
    assert {cluster for _, cluster in handed} == {2}
    if TRANSFERS[transfer] != "async":  # has no mover: the publisher's copy is the arrival
        arrived = traced(trace, "arrive /chatter")
        assert len(arrived) >= 3
        assert Counter(arrived) <= Counter(handed)


def traced(trace: Path, name: str) -> list[tuple[int, int]]:
    """Return message number and receiving cluster of each event of a name."""
    events = json.loads(trace.read_bytes())["traceEvents"]
    found = [event["args"] for event in events if event["name"] == name]
    return [(arguments["number"], arguments["cluster"]) for arguments in found]


def test_the_mapfile_is_shown_and_written_out_with_its_transfers(start, tmp_path, platform) -> None:
    mapfile = write_mapfile(tmp_path, "transfer: message, priority: 7")
    show = start(forked_manycore("map", "show", mapfile, "--json"))
    assert show.wait() == 0
    topic = json.loads(show.output)["topics"][0]
    assert (topic["transfer"], topic["priority"], topic["synchronous"]) == ("message", 7, False)
    table = start(forked_manycore("map", "show", mapfile))
    assert table.wait() == 0
    assert "message, priority 7" in table.output
    create = start(forked_manycore("create", mapfile, "-o", tmp_path / "out"))
    assert create.wait() == 0
    written = (tmp_path / "out" / "topic_table.yaml").read_text()
    assert "transfer: message, priority 7" in written
