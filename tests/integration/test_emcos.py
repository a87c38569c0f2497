# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Messages, sessions and segments between two Python processes."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py import emcos
from rmw_manycore_py.transport import TransportError, TransportTimeoutError
from support import TIMEOUT_S, wait_until
from support.nodes.ros import announce
from support.processes.commands import peer_command
from support.processes.inspection import is_asleep, is_stopped

pytestmark = pytest.mark.integration

SIZE = 1 << 20
WAITS = {"timeout_s": TIMEOUT_S}
PACKET = 4064  # bytes of a message in one packet


def send_messages(count: int) -> None:
    with emcos.MessageSender("t") as sender:
        for number in range(count):
            assert sender.send(bytes([number]) * (number * 1000), priority=number % 8)
        announce("sent")
        sys.stdin.read()


def test_the_highest_priority_comes_first(start, platform: str) -> None:
    peer = start(peer_command(send_messages, 16))
    with emcos.MessageReceiver("t", platform=platform, **WAITS) as receiver:
        peer.wait_for("^sent$")
        only = receiver.receive(mask=emcos.mask_of(2, 4), **WAITS)
        assert only == emcos.Message(4, bytes([4]) * 4000)
        peer.close_input()
        rest = list(receiver)
        assert [message.priority for message in rest] == [
            7,
            7,
            6,
            6,
            5,
            5,
            4,
            3,
            3,
            2,
            2,
            1,
            1,
            0,
            0,
        ]
        assert [len(message.data) for message in rest if message.priority < 2] == [
            1000,
            9000,
            0,
            8000,
        ]
        assert rest[0].data == bytes([7]) * 7000
        with pytest.raises(emcos.PeerGoneError, match="closed its side"):
            receiver.receive()


def test_a_mask_leaves_others_in_their_pipes(start, platform: str) -> None:
    peer = start(peer_command(send_messages, 2))
    with emcos.MessageReceiver("t", platform=platform, **WAITS) as receiver:
        peer.wait_for("^sent$")
        with pytest.raises(TransportTimeoutError, match="no message within 0 s"):
            receiver.receive(mask=emcos.mask_of(7), timeout_s=0)
        peer.kill()
        with pytest.raises(emcos.PeerGoneError, match="ended without closing"):
            receiver.receive(mask=emcos.mask_of(7))
        assert receiver.receive().priority == 1
        assert receiver.receive() == emcos.Message(0, b"")
        with pytest.raises(emcos.PeerGoneError, match="ended without closing"):
            list(receiver)


def receive_on_request() -> None:
    with emcos.MessageReceiver("t") as receiver:
        announce("is there")
        for _ in sys.stdin:
            message = receiver.receive()
            announce(f"got {len(message.data)} {sum(message.data)}")


def test_a_full_pipe_drops_and_counts(start, platform: str) -> None:
    peer = start(peer_command(receive_on_request))
    with emcos.MessageSender("t", platform=platform, **WAITS) as sender:
        peer.wait_for("^is there$")
        sent = 0
        while sender.send(bytes(3 * PACKET)):
            sent += 1
        assert sent >= 1
        assert sender.dropped == 1
        assert sender.send(b"last"), "what was dropped took no room"
        peer.say("")
        peer.wait_for(f"^got {3 * PACKET} ")
        no_room = r"the pipe had no room within 0.01 s; it was dropped: send it again"
        with pytest.raises(TransportTimeoutError, match=no_room):
            sender.send(bytes(8 * PACKET), synchronous=True, timeout_s=0.01)
        assert sender.dropped == 2
        assert sender.send(b"higher", priority=7), "each priority has a pipe"
        for expected in (len(b"higher"), *[3 * PACKET] * (sent - 1), len(b"last")):
            peer.say("")
            peer.wait_for(f"^got {expected} ")
        assert sender.send(b"\1\2"), "what was left of the unfinished message does no harm"
        peer.say("")
        peer.wait_for("^got 2 3$")


def test_a_synchronous_message_waits_for_its_receiver(start, platform: str) -> None:
    peer = start(peer_command(receive_on_request))
    with emcos.MessageSender("t", platform=platform, **WAITS) as sender:
        not_yet = r"was not yet received within 0.01 s; it is in the pipe and may still be received"
        with pytest.raises(TransportTimeoutError, match=not_yet):
            sender.send(b"", synchronous=True, timeout_s=0.01)
        peer.say("")
        peer.say("")
        assert sender.send(b"\1" * (4 << 20), synchronous=True, **WAITS), "larger than the pipe"
        peer.wait_for("^got 0 0$")
        peer.wait_for(f"^got {4 << 20} {4 << 20}$")
        assert sender.dropped == 0


def send_synchronously() -> None:
    with emcos.MessageSender("t") as sender:
        assert sender.send(b"one", synchronous=True, **WAITS)


def test_the_last_word_of_a_receiver_counts(start, platform: str) -> None:
    peer = start(peer_command(send_synchronously))
    with emcos.MessageReceiver("t", platform=platform, **WAITS) as receiver:
        wait_until(lambda: is_asleep(peer.pid), "it waits until its message was received")
        peer.signal(signal.SIGSTOP)
        wait_until(lambda: is_stopped(peer.pid), "it finds all notes at once")
        assert receiver.receive(**WAITS).data == b"one"
    peer.signal(signal.SIGCONT)
    assert peer.wait() == 0, peer


def test_a_message_outlives_its_sender(start, platform: str) -> None:
    peer = start(peer_command(send_synchronously))
    with emcos.MessageReceiver("t", platform=platform, **WAITS) as receiver:
        wait_until(lambda: is_asleep(peer.pid), "it waits until its message was received")
        peer.kill()
        assert receiver.receive(**WAITS).data == b"one"


def test_a_stopped_receiver_holds_nothing_up(start, platform: str) -> None:
    peer = start(peer_command(receive_on_request))
    with emcos.MessageSender("t", platform=platform, **WAITS) as sender:
        peer.wait_for("^is there$")
        peer.signal(signal.SIGSTOP)
        wait_until(lambda: is_stopped(peer.pid), "the receiver is stopped")
        while sender.send(bytes(PACKET)):
            pass
        with pytest.raises(TransportTimeoutError):
            sender.send(b"", synchronous=True, timeout_s=0.01)


def test_a_message_that_never_fits_is_refused(start, platform: str) -> None:
    start(peer_command(receive_on_request))
    with emcos.MessageSender("t", platform=platform, **WAITS) as sender:
        with pytest.raises(
            TransportError, match=r"expected at most \d+ bytes, .* found 1073741824"
        ):
            sender.send(np.zeros(1 << 30, np.uint8))
        with pytest.raises(TransportError, match="data: expected elements one after the other"):
            sender.send(np.zeros((4, 4))[:, 1])
        with pytest.raises(TransportError, match=r"data: expected bytes, .* found str"):
            sender.send("text")  # type: ignore[arg-type]
        with pytest.raises(TransportError, match=r"data: expected bytes, .* found ndarray"):
            sender.send(np.zeros(2, "datetime64[s]"))
        with pytest.raises(TransportError, match=r"priority: .* from 0 to 7, found 8"):
            sender.send(b"", priority=8)
        assert sender.dropped == 0


def move_in_turns() -> None:
    with emcos.SessionSender("s", SIZE, host_cpu=min(os.sched_getaffinity(0))) as session:
        session.buffer[:] = 1
        session.send()
        session.wait(TIMEOUT_S)
        session.buffer[:] = 2
        assert session.send(1000)
        assert not session.send()
        announce(f"dropped {session.dropped}")
        announce("pending")
        session.wait(TIMEOUT_S)
        session.send(0, synchronous=True, **WAITS)


def test_a_session_moves_one_buffer_to_the_other(start, platform: str) -> None:
    peer = start(peer_command(move_in_turns))
    with emcos.SessionReceiver("s", SIZE, platform=platform, **WAITS) as session:
        first = session.receive(TIMEOUT_S)
        assert first.shape == (SIZE,)
        assert (first == 1).all()
        assert not first.flags.writeable
        peer.wait_for("^pending$")
        assert (first == 1).all(), "the buffer is this side's until it is released"
        second = session.receive(TIMEOUT_S)
        assert second.shape == (1000,)
        assert (second == 2).all()
        assert session.receive(TIMEOUT_S).shape == (0,)
        assert list(session) == []
    assert peer.wait() == 0, peer
    assert "dropped 1" in peer.lines


def release_on_request() -> None:
    with emcos.SessionReceiver("s", SIZE) as session:
        while sys.stdin.readline():
            announce(f"moved {session.receive(TIMEOUT_S)[:1]}")


def test_a_synchronous_transfer_that_is_late_is_moved_later(start, platform: str) -> None:
    peer = start(peer_command(release_on_request))
    with emcos.SessionSender("s", SIZE, platform=platform, **WAITS) as session:
        session.buffer[:] = 1
        session.send(synchronous=True, **WAITS)
        session.buffer[:] = 2
        with pytest.raises(TransportTimeoutError, match=r"was not yet moved .*: wait\(\) before"):
            session.send(synchronous=True, timeout_s=0.01)
        with pytest.raises(TransportTimeoutError, match=r"this one was not begun: send it again"):
            session.send(synchronous=True, timeout_s=0.01)
        peer.say("")
        peer.say("")  # releases the first
        session.wait(TIMEOUT_S)
        peer.wait_for(r"^moved \[1\]$")
        peer.wait_for(r"^moved \[2\]$")
        assert session.dropped == 0


def hold_sessions(count: int) -> None:
    sessions = [emcos.SessionReceiver(f"s{number}", 4096) for number in range(count)]
    announce("holds them")
    sys.stdin.read()
    for session in sessions:
        session.close()


def test_a_ninth_session_names_the_eight(start, platform: str) -> None:
    peer = start(peer_command(hold_sessions, 8))
    senders = [
        emcos.SessionSender(f"s{number}", 4096, platform=platform, **WAITS) for number in range(8)
    ]
    peer.wait_for("^holds them$")
    with pytest.raises(TransportError, match="has s0, s1, s2, s3, s4, s5, s6, s7; close one"):
        emcos.SessionSender("s8", 4096, platform=platform, **WAITS)
    senders[3].close()
    with pytest.raises(TransportTimeoutError):
        emcos.SessionSender("s8", 4096, platform=platform, timeout_s=0)
    for sender in senders:
        sender.close()


def put_segments(count: int) -> None:
    with emcos.SegmentWriter("g") as writer:
        for number in range(count):
            assert writer.put(np.full(number, number, np.int32))
    announce("has put them")


def test_segments_outlive_their_writer(start, platform: str) -> None:
    peer = start(peer_command(put_segments, 10))
    with emcos.SegmentReader("g", platform=platform, **WAITS) as reader:
        assert peer.wait() == 0, peer
        taken = list(reader)
        assert [segment.size for segment in taken] == [4 * number for number in range(10)]
    assert all((s.view(np.int32) == s.size // 4).all() for s in taken), "also after close()"


def take_after_a_word() -> None:
    with emcos.SegmentReader("g") as reader:
        sys.stdin.readline()
        numbers = [int(segment.view(np.int64)[0]) for segment in reader]
        assert numbers == list(range(len(numbers)))
        announce(f"took {len(numbers)}")


def test_a_writer_never_waits_for_its_reader(start, platform: str) -> None:
    peer = start(peer_command(take_after_a_word))
    with emcos.SegmentWriter("g", platform=platform, **WAITS) as writer:
        count = 0
        while writer.put(np.full(1000, count, np.int64)):
            count += 1
        assert writer.dropped == 1
    peer.say("")
    peer.wait_for(f"^took {count}$")


def receive_one() -> None:
    announce("opening")
    with emcos.MessageReceiver("t", **WAITS) as receiver:
        announce(receiver.receive(**WAITS).data.decode())


def test_platforms_of_one_name_in_two_directories_are_apart(
    start, tmp_path: Path, platform: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    directories = [tmp_path / name for name in ("one", "two")]
    for directory in directories:
        directory.mkdir(mode=0o700)
    (tmp_path / "link").symlink_to(directories[0])
    receiver = start(peer_command(receive_one), MANYCORE_DIRECTORY=str(directories[0]))
    receiver.wait_for("^opening$")
    wait_until(lambda: is_asleep(receiver.pid), "the receiver listens")
    monkeypatch.setenv("MANYCORE_DIRECTORY", str(directories[1]))
    with pytest.raises(TransportTimeoutError, match="the other side has not come"):
        emcos.MessageSender("t", platform=platform, timeout_s=0)
    monkeypatch.setenv("MANYCORE_DIRECTORY", f"{tmp_path}/link/")
    with emcos.MessageSender("t", platform=platform, **WAITS) as sender:
        assert sender.send(b"hello")
        receiver.wait_for("^hello$")


def test_an_unsuitable_directory_is_refused(
    tmp_path: Path, platform: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MANYCORE_DIRECTORY", f"{tmp_path}/missing")
    with pytest.raises(TransportError, match=r"MessageSender 't': .* `mkdir -p -m 700"):
        emcos.MessageSender("t", platform=platform, timeout_s=0)
