# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic record` and `play` with real nodes, inside, outside, and after a kill."""

from __future__ import annotations

import json
import re
import signal
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from rmw_manycore_py.recording.recording import Recording
from support import IS_MANYCORE, wait_until
from support.nodes.bridging import OUTSIDE
from support.nodes.ros import announce, peer_node, spin_until, type_of
from support.nodes.speakers import hear, qos, say
from support.peers.programs import forked_manycore
from support.processes.commands import peer_command
from support.processes.platforms import leftovers
from support.samples.recordings import text_in, write_texts

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="records on a platform"),
    pytest.mark.needs("mcap", "mcap_ros2", "rosbags"),
]

LATCHED = {"durability": "transient_local", "depth": 3}
BEST_EFFORT = {"reliability": "best_effort"}


def texts_of(path: Path, topic: str) -> list[str]:
    with Recording(path) as recording:
        return [text_in(message.data) for message in recording.messages({topic})]


@pytest.fixture(params=[{}, OUTSIDE], ids=["inside", "outside"])
def place(request: pytest.FixtureRequest) -> dict[str, str]:
    return request.param


def options(place: dict[str, str]) -> list[str]:
    return ["--outside"] if place else []


def record_command(path: Path, *words: str) -> list[Any]:
    return forked_manycore("topic", "record", "-o", path, *words)


def test_other_readers_read_what_was_recorded(start, tmp_path, place) -> None:
    """Transient-local and volatile topics; publishers started before and after the recorder."""
    bag = tmp_path / "bag"
    start(peer_command(say, "/map", LATCHED, None, "first", "second"), **place).wait_for("said")
    recorder = start(record_command(bag, "--all", *options(place)))
    recorder.wait_for(r"^recording /map \(std_msgs/msg/String\)")
    start(peer_command(say, "/news", BEST_EFFORT, 0.02), **place)
    recorder.wait_for("^recording /news")
    file = bag / "bag_0.mcap"
    wait_until(lambda: len(texts_of(file, "/news")) > 5, "messages are on the disk")
    assert recorder.stop() == 0, recorder
    assert re.search(r"bag: \d+ messages of \d+ topics?, ", recorder.output), recorder

    with file.open("rb") as stream:
        decoded = make_reader(stream, decoder_factories=[DecoderFactory()])
        messages = [m.decoded_message for m in decoded.iter_decoded_messages(topics=["/map"])]
    assert [message.data for message in messages] == ["first", "second"]
    with AnyReader([bag]) as reader:
        found = {c.topic: c for c in reader.connections}
        (offer,) = found["/map"].ext.offered_qos_profiles
        assert (offer.durability.name, offer.reliability.name) == ("TRANSIENT_LOCAL", "RELIABLE")
        (offer,) = found["/news"].ext.offered_qos_profiles
        assert (offer.durability.name, offer.reliability.name) == ("VOLATILE", "BEST_EFFORT")
        heard = [
            reader.deserialize(data, connection.msgtype).data
            for connection, _, data in reader.messages([found["/news"]])
        ]
    assert len(heard) > 5
    assert all(text.startswith("again ") for text in heard)


def test_a_player_offers_what_was_recorded(start, tmp_path, place) -> None:
    """A late subscription gets the transient-local messages; best-effort topics are played so."""
    bag = tmp_path / "bag.mcap"
    speaker = start(peer_command(say, "/map", LATCHED, None, "first", "second"), **place)
    recorder = start(record_command(bag, "/map", *options(place)))
    recorder.wait_for("^recording /map")
    wait_until(lambda: texts_of(bag, "/map") == ["first", "second"], "they are on the disk")
    recorder.stop()
    speaker.kill()
    # The second message is much later, so the player still runs.
    play = ["topic", "play", bag, "--remap", "/map:=/old_map", "--rate", "0.01", "--loop"]
    start(forked_manycore(*play, "--delay", "0.01", *options(place)))
    hearer = start(peer_command(hear, "/old_map", LATCHED), **place)
    hearer.wait_for("^heard first")


def test_a_killed_recorder_leaves_what_can_be_read_and_played(start, tmp_path) -> None:
    bag = tmp_path / "bag"
    start(peer_command(say, "/news", {}, 0.01))
    recorder = start(record_command(bag, "/news"))
    file = bag / "bag_0.mcap"
    wait_until(lambda: file.exists() and file.stat().st_size > 4096, "some is on the disk")
    recorder.signal(signal.SIGKILL)
    recorder.wait()
    texts = texts_of(bag, "/news")
    assert len(texts) > 10
    with file.open("rb") as stream:
        others = []
        with suppress(EndOfFile):  # as it was not finished
            for _, _, message in NonSeekingReader(stream).iter_messages(log_time_order=False):
                others.append(text_in(message.data))
    assert others == texts
    info = start(forked_manycore("bag", "info", bag))
    assert info.wait() == 0
    assert f"Messages:          {len(texts)}" in info.lines
    assert "it was not finished" in info.output
    hearer = start(peer_command(hear, "/again", {"depth": 1000}))
    hearer.wait_for("listening")
    play = ["topic", "play", bag, "--rate", "100", "--remap", "/news:=/again", "--json"]
    player = start(forked_manycore(*play))
    assert player.wait() == 0
    assert json.loads(player.lines[-1])["messages"] == len(texts)
    assert [hearer.wait_for("^heard (again .*) ").group(1) for _ in texts] == texts


def test_a_publisher_that_offers_less_is_heard_too(start, platform, tmp_path) -> None:
    """The recorder subscribes again; no message is lost, and the latched one is stored once."""
    bag = tmp_path / "bag.mcap"
    kept = {"durability": "transient_local", "depth": 1000}
    recorder = start(record_command(bag, "/news"))
    wait_until(lambda: leftovers(platform), "the recorder looks")
    start(peer_command(say, "/news", kept, 0.02, "first"))  # kept for 20 s
    recorder.wait_for("^recording /news")
    start(peer_command(say, "/news", {**BEST_EFFORT, **kept}, 0.02))
    recorder.wait_for("some publishers offer best effort")
    size = bag.stat().st_size
    wait_until(lambda: bag.stat().st_size > size + 8192, "both are recorded")
    recorder.stop()
    texts = texts_of(bag, "/news")
    assert texts[0] == "first"
    assert len(set(texts)) == len(texts)
    with Recording(bag) as recording:
        assert {q.reliability for q in recording.topics[0].offers} >= {"reliable"}
    assert "lost" not in recorder.output


def test_a_player_keeps_order_and_rate_and_publishes_the_clock(start, tmp_path) -> None:
    """The player publishes /clock at its own rate, and plays from the offset for the duration."""
    texts = [("/a", 20.0 * n, f"text {n}") for n in range(8)]
    bag = write_texts(tmp_path / "a.mcap", texts, each=2)
    clock = start(peer_command(hear_clock))
    clock.wait_for("listening")
    hearer = start(peer_command(hear, "/a", {}))
    hearer.wait_for("listening")
    words = ["--rate", "20", "--start-offset", "40", "--duration", "60", "--clock", "100"]
    player = start(forked_manycore("topic", "play", bag, *words))
    assert player.wait() == 0
    assert player.lines[-1].startswith("played 4 messages; late by")
    for number in range(2, 6):
        assert hearer.wait_for("^heard (.*) ").group(1) == f"text {number}"
    told = r"^clock 1700000(0[4-9]\d|100)\."
    first_s = float(clock.wait_for(told).string.split()[1])
    while float(clock.wait_for(told).string.split()[1]) <= first_s:
        pass


def hear_clock() -> None:
    with peer_node("hearer") as node:
        node.create_subscription(
            type_of("rosgraph_msgs/msg/Clock"),
            "/clock",
            lambda m: announce(f"clock {m.clock.sec}.{m.clock.nanosec:09}"),
            qos({**BEST_EFFORT, "depth": 1000}),
        )
        announce("listening")
        spin_until(node, lambda: False, 1e6)
