# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors of recordings: full disks, types that clash or are missing, wrong arguments."""

from __future__ import annotations

import shlex
from contextlib import closing
from pathlib import Path

import pytest

from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.native._transport import Process, Qos
from rmw_manycore_py.recording.output import Output
from rmw_manycore_py.recording.recording import Recording
from support import IS_MANYCORE, TIMEOUT_S, wait_until
from support.installs.building import write_definitions
from support.nodes.ros import peer_node, spin_until, type_of
from support.nodes.speakers import hear, say
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command, peer_command
from support.processes.own_shm import can_mount
from support.processes.person import Person
from support.processes.platforms import environment
from support.samples.recordings import NS_PER_S, START_NS, string_row, text_message, write_texts
from support.sources.advice import run_quoted

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="records on a platform"),
    pytest.mark.needs("mcap"),
]

NIX = {"nix_msgs/msg/Nix.msg": "string text\n"}
NIX_HASH = "RIHS01_f075c58ee7960f749a601ae54cbf414fc697bb3963a1313a6106d5ec98bd1ae7"
ON_SMALL_DISK = r"""
mount -t tmpfs -o size=3m tmpfs "$0" && "$@" 2>"$0.errors"
status=$?
cat "$0.errors" >&2
PATH=$(dirname "$1"):$PATH
eval "$(sed -n 's/.*`\(manycore bag info .*\)`.*/\1/p' "$0.errors")"
exit $status
"""


def on_small_disk(directory: object, *command: object) -> list[str]:
    """Return a command that runs with its directory on a small disk, then as its error advises."""
    return ["unshare", "--mount", "sh", "-c", ON_SMALL_DISK, str(directory), *map(str, command)]


@pytest.mark.skipif(not can_mount(), reason="needs root and a mount namespace")
def test_a_full_disk_ends_the_recording_and_spares_what_is_there(start, tmp_path) -> None:
    start(peer_command(say_large, "/large"))
    disk = tmp_path / "the user's disk"
    disk.mkdir()
    record = manycore_command("topic", "record", "/large", "-o", disk / "a.mcap")
    recorder = start(on_small_disk(disk, *record))
    assert recorder.wait() == 1, recorder
    held = recorder.wait_for(
        r"a\.mcap: cannot be written: No space left on device; it holds (\d+) messages"
    )
    assert int(held.group(1)) > 10
    recorder.wait_for(rf"^Messages: +{held.group(1)}$")


def say_large(topic: str) -> None:
    with peer_node("speaker") as node:
        message = type_of("std_msgs/msg/String")(data=65536 * "x")
        publisher = node.create_publisher(type(message), topic, 10)
        node.create_timer(0.01, lambda: publisher.publish(message))
        spin_until(node, lambda: False, 1e6)


@pytest.mark.parametrize("ignored", ["", "trap '' HUP; "], ids=["SIGHUP", "nohup"])
def test_a_terminal_that_hangs_up_leaves_a_whole_recording(
    start, platform, tmp_path, ignored
) -> None:
    bag = tmp_path / "bag"
    start(peer_command(say, "/news", {}, 0.02)).wait_for("said")
    record = manycore_command("topic", "record", "/news", "-o", bag, "--duration", "2")
    shell = ["sh", "-c", f"{ignored}exec {shlex.join(map(str, record))}"]
    with closing(Person(shell, environment(platform))) as person:
        person.sees(r"\d messages")
        person.hangs_up()
        assert person.process.wait(TIMEOUT_S) == 0
    check_is_whole(bag)


@pytest.mark.parametrize("where", ["2>/dev/full", "2>&1 | head -n 1"])
def test_a_recording_goes_on_without_its_output(start, tmp_path, where) -> None:
    bag = tmp_path / "bag"
    start(peer_command(say, "/news", {}, 0.02)).wait_for("said")
    record = manycore_command("topic", "record", "/news", "-o", bag, "--duration", "1")
    start(["sh", "-c", f"{shlex.join(map(str, record))} {where}"]).wait()
    check_is_whole(bag)


def test_a_recording_may_last_long(start, tmp_path) -> None:
    start(peer_command(say, "/news", {}, 0.02)).wait_for("said")
    words = ("/news", "-o", tmp_path / "bag", "--duration", "720h", "--json")
    recorder = start(forked_manycore("topic", "record", *words))
    file = tmp_path / "bag" / "bag_0.mcap"
    wait_until(lambda: file.exists() and file.stat().st_size > 2048, "some is on the disk")
    assert recorder.stop() == 0, recorder
    check_is_whole(tmp_path / "bag")


def check_is_whole(bag: Path) -> None:
    assert (bag / "metadata.yaml").exists()
    with Recording(bag) as recording:
        assert not recording.faults
        assert recording.span.messages > 0


def test_a_terminal_that_hangs_up_ends_the_player(platform, tmp_path) -> None:
    bag = write_texts(tmp_path / "a.mcap", [("/a", 0, "x"), ("/a", 1000, "y")])
    play = manycore_command("topic", "play", bag)
    with closing(Person(play, environment(platform))) as person:
        person.sees("playing")
        person.hangs_up()
        person.process.wait(TIMEOUT_S)


def test_what_is_there_is_not_overwritten(start, tmp_path) -> None:
    bag = write_texts(tmp_path / "a.mcap", [("/a", 0, "precious")])
    for path, complaint in (
        (bag, "already exists"),
        (tmp_path / "nix" / "b.mcap", "No such file or directory"),
        (tmp_path / "nix" / "b", "No such file or directory"),
    ):
        recorder = start(forked_manycore("topic", "record", "/a", "-o", path))
        assert recorder.wait() == EXIT_BAD_INPUT
        assert complaint in recorder.output, recorder
    with Recording(bag) as recording:
        assert recording.span.messages == 1


def test_record_refuses_an_empty_selection(start, tmp_path) -> None:
    recorder = start(forked_manycore("topic", "record", "-o", tmp_path / "a.mcap"))
    assert recorder.wait() == EXIT_BAD_INPUT
    assert "no topics given" in recorder.output
    assert not (tmp_path / "a.mcap").exists()


def test_a_type_without_definition_is_recorded_and_played_inside(
    start, platform, tmp_path, monkeypatch
) -> None:
    monkeypatch.setenv("MANYCORE_INTERFACES", str(tmp_path / "built"))
    bag = tmp_path / "a.mcap"
    with Process(platform, label="strange") as process:
        publisher = process.publisher("/strange", "nix_msgs/msg/Nix", Qos(), type_hash=NIX_HASH)
        recorder = start(forked_manycore("topic", "record", "/strange", "-o", bag))
        recorder.wait_for("type nix_msgs/msg/Nix is not installed.*manycore interface build")
        wait_until(publisher.matched, "the recorder listens")
        publisher.publish(b"\0\1\0\0abcd")
        wait_until(lambda: bag.stat().st_size > 300, "it is on the disk")
        recorder.stop()
        del publisher
    player = start(forked_manycore("topic", "play", bag))
    assert player.wait() == 0, player
    outside = start(forked_manycore("topic", "play", bag, "--outside"))
    assert outside.wait() == 1
    assert "nix_msgs" in outside.output
    sources = write_definitions(tmp_path / "sources", NIX)
    run_quoted(outside.output, "manycore interface build", PATH=sources)
    again = start(forked_manycore("topic", "play", bag, "--outside"))
    assert again.wait() == 0, again


def test_a_topic_with_two_types_is_left_out(start, platform, tmp_path) -> None:
    with Process(platform, label="strange") as process:
        publishers = [
            process.publisher("/a", f"std_msgs/msg/{name}", Qos()) for name in ("String", "Int8")
        ]
        recorder = start(forked_manycore("topic", "record", "--all", "-o", tmp_path / "a.mcap"))
        recorder.wait_for(
            "not recorded: /a has several types, std_msgs/msg/Int8 and std_msgs/msg/String"
        )
        assert recorder.stop() == 0
        del publishers


@pytest.mark.parametrize("kind", ["type", "definition"])
def test_a_player_does_not_play_to_another_type(start, platform, tmp_path, kind) -> None:
    bag = tmp_path / "a.mcap"
    output, row = Output(bag), string_row("/a", type_hash="RIHS01_" + 64 * "1")
    output.write(row, 1, 1, 1, text_message("x"))
    output.finish([row])
    type_name = "std_msgs/msg/Int8" if kind == "type" else "std_msgs/msg/String"
    with Process(platform, label="strange") as process:
        subscription = process.subscription("/a", type_name, Qos(), type_hash="RIHS01_" + 64 * "2")
        player = start(forked_manycore("topic", "play", bag))
        assert player.wait() == 1
        assert "another definition" in player.output or "std_msgs/msg/Int8 here" in player.output
        assert "--exclude-topics /a" in player.output
        del subscription


def test_play_reports_a_gap_and_goes_on(start, tmp_path) -> None:
    end_s = (2**64 - 1 - START_NS) // NS_PER_S - 1
    bag = write_texts(tmp_path / "a.mcap", [("/a", 0, "x"), ("/a", end_s, "y")])
    hearer = start(peer_command(hear, "/a", {}))
    hearer.wait_for("listening")
    player = start(forked_manycore("topic", "play", bag))
    player.wait_for("no message for 530.7 years after 0.000 s: playing waits as long; --duration 0")
    hearer.wait_for("^heard x ")
    assert player.stop() == 0, player
    assert player.lines[-1].startswith("played 1 message; late by")


def test_play_rejects_invalid_options(start, tmp_path) -> None:
    bag = write_texts(tmp_path / "a.mcap", [("/a", 0, "x"), ("/a", 1, "y")])
    for words, complaint in (
        (["--topics", "/b"], "expected the topic /b, found /a"),
        (["--exclude-topics", "/a"], "no topic is left"),
        (["--start-offset", "2"], "is 1.000 s long"),
        (["--remap", "/a"], "expected OLD:=NEW, found '/a'"),
        (["--regex", "("], "is not a regular expression"),
        (["--rate", "0"], "--rate"),
        (["--rate", "nan"], "expected a number up to 4e+09, found nan"),
        (["--start-offset", "1e300"], "found 1e300"),
        (["--duration", "inf"], "found inf"),
    ):
        player = start(forked_manycore("topic", "play", bag, *words))
        assert player.wait() == EXIT_BAD_INPUT, player
        assert complaint in player.output, player
