# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ends of transfers that are killed at named lines, interrupted, forked, or have no memory."""

from __future__ import annotations

import gc
import linecache
import os
import re
import signal
import socket
import sys
import threading
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from rmw_manycore_py import emcos
from rmw_manycore_py.emcos.memory import create_memory
from rmw_manycore_py.emcos.rendezvous import _address
from rmw_manycore_py.process.parent_death import dies_with_this_process
from rmw_manycore_py.transport import TransportError, TransportTimeoutError
from support import wait_until
from support.nodes.emcos_ends import OPEN, OTHER, SIZE, WAITS, run, use
from support.nodes.ros import announce
from support.processes.commands import manycore_command, peer_command
from support.processes.inspection import is_asleep, is_stopped
from support.sources.advice import run_quoted

pytestmark = pytest.mark.integration


NOBODY = 65534


def signal_before(line: str, hits: int, number: signal.Signals = signal.SIGKILL) -> None:
    """Send a signal to this process before a line of `emcos` runs for the nth time.

    Threads that are started later count, too.
    """
    left = hits

    def trace(frame: FrameType, event: str, argument: Any) -> Any:
        nonlocal left
        if "/emcos/" not in frame.f_code.co_filename:
            return None
        if event == "line":
            text = linecache.getline(frame.f_code.co_filename, frame.f_lineno)
            if text.strip().startswith(line):
                left -= 1
                if left == 0:
                    os.kill(os.getpid(), number)
        return trace

    threading.settrace(trace)
    sys.settrace(trace)


def run_and_die(role: str, line: str, hits: int) -> None:
    signal_before(line, hits)
    run(role)


def act_and_die(action: str, line: str) -> None:
    signal_before(line, 1)
    globals()[action]()


def names_of(pid: int) -> list[Path]:
    """Return the names of shared memory that a process has made."""
    return list(Path("/dev/shm").glob(f"manycore-emcos-*.{pid}.*"))


def has_first_side(platform: str) -> bool:
    """Return whether a side of the transfer `t` has bound its address: the next one connects."""
    address = _address(platform, "t").decode().replace("\0", "@")
    return address in Path("/proc/net/unix").read_text().split()


def open_descriptors() -> int:
    return len(os.listdir("/proc/self/fd"))


# (what the killed process does, the line before which it is killed, which time)
KILLS = [
    ("send", "told = self._link.tell(NoteKind.PIPE", 1),
    ("send", "os.writev(self.descriptor, packet)", 3),  # in the middle of a message
    ("send", "while self._received != self._number", 1),
    ("receive", "self._pipes[note.value] = ", 1),
    ("receive", "self._data += packet.body", 3),
    ("receive", "self._link.tell(NoteKind.RECEIVED", 1),
    ("move", "return map_memory(descriptor, size_bytes)", 1),
    ("move", "np.copyto(", 2),
    ("move", "self._link.tell(NoteKind.MOVED", 2),
    ("take moved", "segment.unlink()", 1),
    ("take moved", "self._link.tell(NoteKind.BUFFER", 1),
    ("take moved", "self._link.tell(NoteKind.RELEASED", 2),
    ("put", "segment.unlink()", 2),
    ("put", "np.copyto(", 2),
    ("put", "return self._link.tell(NoteKind.SEGMENT", 2),
    ("take", "return map_memory(descriptor, size_bytes)", 2),
]


@pytest.mark.parametrize(("role", "line", "hits"), KILLS)
def test_a_killed_side_leaves_nothing(
    start, platform: str, role: str, line: str, hits: int
) -> None:
    for _ in range(2):  # the name serves the next pair
        victim = start(peer_command(run_and_die, role, line, hits))
        before = open_descriptors()
        with pytest.raises(emcos.PeerGoneError, match="ended without closing its side"):
            run(OTHER[role], platform)
        assert victim.wait() == -signal.SIGKILL, victim
        assert names_of(victim.pid) == []
        assert open_descriptors() <= before
        gc.collect()  # the error's traceback refers to its frames, and they to arrays
        assert "manycore-emcos" not in Path("/proc/self/maps").read_text()


def make_memory() -> None:
    os.close(create_memory(SIZE, "memory"))


def make_memory_and_stop() -> None:
    signal_before("segment.unlink()", 1, signal.SIGSTOP)
    make_memory()


def open_in_vain(platform: str) -> None:
    with pytest.raises(TransportTimeoutError, match="the other side has not come in time"):
        emcos.SegmentReader("unused", platform=platform, timeout_s=0)


def test_the_next_opening_removes_names_of_the_dead_only(start, platform: str) -> None:
    dead = start(peer_command(act_and_die, "make_memory", "segment.unlink()"))
    assert dead.wait() == -signal.SIGKILL, dead
    alive = start(peer_command(make_memory_and_stop))
    wait_until(lambda: is_stopped(alive.pid), "it has not unlinked the name yet")
    open_in_vain(platform)
    assert names_of(dead.pid) == []
    assert len(names_of(alive.pid)) == 1
    alive.signal(signal.SIGCONT)
    assert alive.wait() == 0, alive
    assert names_of(alive.pid) == []


def send_one() -> None:
    with emcos.MessageSender("t", **WAITS) as sender:
        sender.send(b"one", synchronous=True, **WAITS)


def receive_one() -> None:
    with emcos.MessageReceiver("t", **WAITS) as receiver:
        announce(f"got {receiver.receive(**WAITS).data.decode()}")


@pytest.mark.parametrize(
    "line", ["listener.listen(1)", "connection, _ =", "connection.send(hello)"]
)
def test_the_first_side_dies_while_it_opens(start, platform: str, line: str) -> None:
    victim = start(peer_command(act_and_die, "send_one", line))
    wait_until(lambda: has_first_side(platform) or not victim.is_running(), "it came first")
    survivor = start(peer_command(receive_one))
    assert victim.wait() == -signal.SIGKILL, victim
    partner = start(peer_command(send_one))
    survivor.wait_for("^got one$")
    assert partner.wait() == 0, partner


@pytest.mark.parametrize("line", ["connection.connect(address)", "connection.send(hello)"])
def test_the_second_side_dies_while_it_opens(start, platform: str, line: str) -> None:
    survivor = start(peer_command(receive_one))
    wait_until(lambda: has_first_side(platform), "the survivor came first")
    victim = start(peer_command(act_and_die, "send_one", line))
    assert victim.wait() == -signal.SIGKILL, victim
    partner = start(peer_command(send_one))
    survivor.wait_for("^got one$")
    assert partner.wait() == 0, partner


def fork_and_wait() -> None:
    with emcos.MessageSender("t", **WAITS) as sender:
        if os.fork() == 0:
            try:
                sender.send(b"")
            except TransportError as error:
                announce(f"child: {error}")
            sys.stdin.read()
            os._exit(0)
        sender.send(b"from the parent")
        signal.pause()


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_forked_child_neither_sends_nor_hides_its_parents_death(start, platform: str) -> None:
    peer = start(peer_command(fork_and_wait))
    try:
        with emcos.MessageReceiver("t", platform=platform, **WAITS) as receiver:
            assert receiver.receive(**WAITS).data == b"from the parent"
            peer.wait_for("^child: MessageSender 't': this side belongs to the parent process: ")
            peer.signal(signal.SIGKILL)
            with pytest.raises(emcos.PeerGoneError, match="ended without closing"):
                receiver.receive(**WAITS)
    finally:
        peer.close_input()  # the child ends


def interrupted(role: str) -> None:
    announce("begins")
    try:
        run(role)
    except KeyboardInterrupt:
        announce("interrupted")


@pytest.mark.parametrize("role", ["send", "receive", "move", "take moved", "take"])
def test_ctrl_c_closes_an_end(start, platform: str, role: str) -> None:
    peer = start(peer_command(interrupted, role))
    with OPEN[OTHER[role]](platform) as end:
        wait_until(lambda: is_asleep(peer.pid), "it waits for this side")
        assert peer.stop() == 0, peer
        assert peer.lines == ["begins", "interrupted"]
        with pytest.raises(emcos.PeerGoneError, match="closed its side"):
            use(end, OTHER[role])


def test_ctrl_c_ends_the_search_for_a_peer(start) -> None:
    peer = start(peer_command(interrupted, "receive"))
    peer.wait_for("^begins$")
    wait_until(lambda: is_asleep(peer.pid), "it waits for its peer")
    assert peer.stop() == 0, peer
    assert peer.lines == ["begins", "interrupted"]


def test_two_senders_do_not_fit(start, platform: str) -> None:
    peer = start(peer_command(send_one))
    expected = "expected a MessageReceiver of this name, found a MessageSender"
    with pytest.raises(TransportError, match=expected):
        emcos.MessageSender("t", platform=platform, **WAITS)
    assert peer.wait() == 1, peer
    assert expected in peer.lines[-1]


def test_sessions_of_two_sizes_do_not_fit(start, platform: str) -> None:
    start(peer_command(run, "take moved"))
    with pytest.raises(TransportError, match="a buffer of 5 bytes on both sides, found 65536 on"):
        emcos.SessionSender("t", 5, platform=platform, **WAITS)
    for size in (0, -1, 1 << 60, 1.5):
        with pytest.raises(TransportError, match="size_bytes: expected a whole number from 1 to"):
            emcos.SessionSender("t", size, platform=platform, **WAITS)  # type: ignore[arg-type]


def as_another_user(platform: str, action: str) -> None:
    """Listen on the address of this user's transfers, or connect to it, as another user."""
    address = _address(platform, "t")
    os.setuid(NOBODY)
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as own:
        if action == "listen":
            own.bind(address)
            own.listen()
        else:
            own.connect(address)
        announce("done")
        sys.stdin.read()


@pytest.mark.skipif(os.getuid() != 0, reason="needs root, to become another user")
def test_another_user_can_hold_an_address_but_not_be_a_peer(start, platform: str) -> None:
    squatter = start(peer_command(as_another_user, platform, "listen"))
    squatter.wait_for("^done$")
    with pytest.raises(TransportError, match=f"address is held by a process of user {NOBODY}; end"):
        run("receive", platform)
    squatter.close_input()
    assert squatter.wait() == 0, squatter
    waiting = start(peer_command(receive_one))
    wait_until(lambda: has_first_side(platform), "it came first")
    intruder = start(peer_command(as_another_user, platform, "connect"))
    intruder.wait_for("^done$")
    start(peer_command(send_one))
    waiting.wait_for("^got one$")
    intruder.close_input()


SMALL_SHM = 'mount -t tmpfs -o size=1m,mode=1777 tmpfs /dev/shm && exec "$@"'


def read_when_told() -> None:
    """Be the child's side of `fill_shared_memory`."""
    with emcos.SegmentReader("t", **WAITS) as reader:
        sys.stdin.readline()
        announce(f"took {sum(segment.size for segment in reader)}")
    try:
        emcos.SessionReceiver("s", 1 << 30, **WAITS)
    except TransportError as error:
        announce(f"refused: {error}")


def fill_shared_memory() -> None:
    die_with_parent = dies_with_this_process()
    child = os.fork()
    if child == 0:
        die_with_parent()
        read_when_told()
        os._exit(0)
    with emcos.SegmentWriter("t", **WAITS) as writer:
        count = 0
        try:
            while writer.put(bytes(SIZE)):
                count += 1
        except TransportError as error:
            refusal = str(error)
            announce(f"after {count * SIZE}: {refusal}")
        sys.stdout.flush()
        announce(f"empty: {writer.put(b'')}")
        run_quoted(refusal, "mount")
        announce(f"enlarged: {writer.put(bytes(SIZE))}")
    try:
        emcos.SessionSender("s", 1 << 30, **WAITS)
    except emcos.PeerGoneError as error:
        announce(f"gone: {error}")
    os.waitpid(child, 0)


@pytest.mark.skipif(os.getuid() != 0, reason="needs root, for a mount namespace")
def test_a_full_dev_shm_gives_the_size_needed(start) -> None:
    command = peer_command(fill_shared_memory)
    filler = start(["unshare", "--mount", "sh", "-c", SMALL_SHM, "sh", *command])
    found = filler.wait_for(
        r"^after (\d+): .*no room for (\d+) bytes in /dev/shm, which has (\d+) "
    )
    put, wanted, free = map(int, found.groups())
    assert wanted == SIZE > free
    filler.wait_for("^empty: True$")
    filler.wait_for("^enlarged: True$")
    filler.say("")
    filler.wait_for(f"^took {put + SIZE}$")
    assert filler.wait() == 0, filler
    assert f"refused: SessionReceiver 's': no room for {1 << 30} bytes in /dev/shm" in filler.output
    assert "gone: SessionSender 's': the other process closed its side" in filler.lines


CLEANED = 'mount -t tmpfs -o size=1m,mode=1777 tmpfs /dev/shm && "$@"; "$0" clean'


@pytest.mark.skipif(os.getuid() != 0, reason="needs root, for a mount namespace")
def test_manycore_clean_removes_a_name_of_the_dead(start) -> None:
    command = peer_command(act_and_die, "make_memory", "segment.unlink()")
    cleaned = start(["unshare", "--mount", "sh", "-c", CLEANED, *manycore_command(), *command])
    assert cleaned.wait() == 0, cleaned
    assert re.fullmatch(r"/dev/shm/manycore-emcos-0\.\d+\.\d+\.\d+\.0", cleaned.lines[-1]), cleaned
