# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrays without ROS, published and taken by one process of a real platform."""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rmw_manycore_py as manycore
from rmw_manycore_py import transport
from rmw_manycore_py.native._transport import Configurator
from rmw_manycore_py.transport.multi_array import TYPES
from support import TIMEOUT_S, wait_until
from support.processes.platforms import leftovers
from support.sources.advice import run_quoted

pytestmark = pytest.mark.integration

Ends = tuple[transport.Publisher[Any], transport.Subscription[Any]]


@pytest.fixture
def member(platform: str) -> Iterator[transport.Member]:
    with transport.join(platform, name="tester") as member:
        yield member


@pytest.fixture
def ends(member: transport.Member) -> Ends:
    """Both ends of a topic that keeps one message."""
    subscription = member.subscription("/floats", np.float32, qos=1)
    return member.publisher("/floats", np.float32, qos=1), subscription


@pytest.mark.parametrize("dtype", TYPES, ids=str)
def test_an_array_arrives_as_it_was(member: transport.Member, dtype: np.dtype[Any]) -> None:
    subscription = member.subscription("/arrays", dtype)
    publisher = member.publisher("/arrays", dtype)
    sent = np.arange(24, dtype=dtype).reshape(2, 3, 4)
    for number, array in enumerate((sent, sent[:, ::2], sent[:0], np.asfortranarray(sent)), 1):
        assert publisher.publish(array) == number
        with subscription.take(TIMEOUT_S) as message:
            assert (message.sequence, message.array.dtype) == (number, dtype)
            assert np.array_equal(message.array, array)
            assert message.array.shape == array.shape


def test_an_array_is_read_in_its_place(ends: Ends, platform: str) -> None:
    publisher, subscription = ends
    publisher.publish(np.ones(1000, np.float32))
    with subscription.take(TIMEOUT_S) as message:
        address = message.array.__array_interface__["data"][0]
        assert f"{platform}/cluster-1" in mapping_of(address)
        assert message.array.flags.aligned
        assert not message.array.flags.owndata
        with pytest.raises(ValueError, match="read-only"):
            message.array[0] = 2.0
        kept = message.copy()
        assert "cluster" not in mapping_of(kept.__array_interface__["data"][0])
        kept += 1


def mapping_of(address: int) -> str:
    """Return the file that is mapped at an address of this process."""
    for line in Path("/proc/self/maps").read_text().splitlines():
        begin, end = (int(number, 16) for number in line.split()[0].split("-"))
        if begin <= address < end:
            return line
    raise AssertionError(f"nothing is mapped at {address:x}")


def test_a_message_stays_while_its_publisher_overwrites(ends: Ends) -> None:
    publisher, subscription = ends
    publisher.publish(np.full(10_000, 1.0, np.float32))
    with subscription.take(TIMEOUT_S) as message:
        for number in range(2, 200):
            publisher.publish(np.full(10_000, number, np.float32))
        assert np.all(message.array == 1.0)
    with subscription.take(TIMEOUT_S) as message:
        assert (message.sequence, message.array[-1]) == (199, 199.0)
    assert (subscription.lost, subscription.superseded) == (0, 197)


def test_arrays_whose_shapes_change(ends: Ends) -> None:
    publisher, subscription = ends
    for shape in [(2, 3), (3, 2), (3, 2), (6,), (0, 6), (2, 3)]:
        publisher.publish(np.ones(shape, np.float32))
        assert subscription.take_copy(TIMEOUT_S).shape == shape


def test_an_array_that_outlives_its_message_stays_whole(ends: Ends) -> None:
    publisher, subscription = ends
    publisher.publish(np.full(1000, 1.0, np.float32))
    with (
        pytest.raises(transport.MessageInUseError, match=r"keep message\.copy\(\) instead"),
        subscription.take(TIMEOUT_S) as message,
    ):
        part = message.array[10:20].reshape(2, 5)
    for number in range(2, 100):
        publisher.publish(np.full(1000, number, np.float32))
    assert np.all(part == 1.0)
    with pytest.raises(transport.MessageInUseError, match="/floats: an array of the message"):
        subscription.take(TIMEOUT_S)
    del part
    with subscription.take(TIMEOUT_S) as message:
        assert message.array[0] == 99.0


def test_one_message_is_taken_at_a_time(ends: Ends) -> None:
    publisher, subscription = ends
    publisher.publish(np.ones(3, np.float32))
    message = subscription.take(TIMEOUT_S)
    publisher.publish(np.ones(4, np.float32))
    with pytest.raises(transport.MessageInUseError):
        subscription.try_take()
    message.release()
    message.release()
    with pytest.raises(transport.TransportError, match=r"the message was released: .* copy\(\)"):
        message.array  # noqa: B018 - the look is the test
    assert subscription.take_copy(TIMEOUT_S).shape == (4,)


def test_an_error_inside_with_is_the_one_that_is_seen(ends: Ends) -> None:
    publisher, subscription = ends
    publisher.publish(np.ones(3, np.float32))
    kept: list[object] = []

    def fail(message: transport.Message[Any]) -> None:
        kept.append(message.array)
        raise RuntimeError("of the caller")

    with pytest.raises(RuntimeError, match="of the caller"), subscription.take(0) as message:
        fail(message)
    kept.clear()
    publisher.publish(np.ones(4, np.float32))
    assert subscription.take_copy(TIMEOUT_S).shape == (4,)


def test_another_thread_may_be_the_last_with_an_array(ends: Ends) -> None:
    publisher, subscription = ends
    for number in range(1, 4):
        publisher.publish(np.full(100, number, np.float32))
        message = subscription.take(TIMEOUT_S)
        begins = threading.Event()
        arrays = [message.array]
        thread = threading.Thread(target=lambda: (begins.wait(), arrays.clear()))  # noqa: B023
        thread.start()
        with pytest.raises(transport.MessageInUseError):
            message.release()
        begins.set()
        thread.join()


def test_threads_share_a_subscription(ends: Ends) -> None:
    publisher, subscription = ends
    held = threading.Event()
    results: list[object] = []

    def take() -> None:
        held.wait()
        try:
            results.append(subscription.take(TIMEOUT_S))
        except transport.MessageInUseError as error:
            results.append(error)

    publisher.publish(np.ones(3, np.float32))
    threads = [threading.Thread(target=take) for _ in range(4)]
    for thread in threads:
        thread.start()
    with subscription.take(TIMEOUT_S):
        held.set()
        for thread in threads:
            thread.join()
    assert [type(result) for result in results] == [transport.MessageInUseError] * 4


def test_a_loop_takes_one_after_the_other(member: transport.Member) -> None:
    subscription = member.subscription("/numbers", np.int64, qos=100)
    publisher = member.publisher("/numbers", np.int64, qos=100)
    for number in range(50):
        publisher.publish(np.array([number]))
    taken = []
    for message in subscription:
        taken.append(int(message.array[0]))
        if taken[-1] == 49:
            break
    assert taken == list(range(50))
    assert subscription.try_take() is None


def test_waiting_ends_in_time(ends: Ends) -> None:
    publisher, subscription = ends
    assert subscription.try_take() is None
    for timeout_s in (0, 0.01):
        with pytest.raises(transport.TransportTimeoutError, match="/floats: no message within 0"):
            subscription.take(timeout_s)
    publisher.wait_for_subscriptions(1, TIMEOUT_S)
    with pytest.raises(TimeoutError, match=r"/floats: 1 of 2 subscriptions") as timed_out:
        publisher.wait_for_subscriptions(2, 0.01)
    advised = run_quoted(str(timed_out.value), "manycore topic info -v")
    assert advised.count("Topic type: ") == advised.count("Reliability: ") == 2
    assert (publisher.subscriptions, subscription.publishers) == (1, 1)


@pytest.mark.parametrize("closed", ["subscription", "member"])
def test_closing_wakes_a_thread_that_waits(
    member: transport.Member, ends: Ends, closed: str
) -> None:
    subscription = ends[1]
    errors: list[str] = []

    def take() -> None:
        try:
            subscription.take()
        except transport.TransportError as error:
            errors.append(str(error))

    thread = threading.Thread(target=take, name="taker")
    thread.start()
    wait_until(lambda: is_asleep_in(thread), "it sleeps")
    (subscription if closed == "subscription" else member).close()
    thread.join(TIMEOUT_S)
    assert errors == ["/floats: the subscription is closed"]


def is_asleep_in(thread: threading.Thread) -> bool:
    """Return whether a thread of this process waits on a futex of a platform, not for the GIL."""
    number, *arguments = Path(f"/proc/self/task/{thread.native_id}/syscall").read_text().split()
    return number == "202" and "/registry" in mapping_of(int(arguments[0], 16))


def test_with_joins_and_leaves(platform: str) -> None:
    with transport.join(platform, cluster=2, core=3, name="tester") as member:
        assert (member.platform, member.cluster, member.core) == (platform, 2, 3)
        with member.publisher("/t", np.int8) as publisher, member.subscription("/t", np.int8):
            status = manycore.status(platform)
        (process,) = status.processes
        assert (process.cluster, process.core, process.nodes) == (2, 3, ("/tester",))
        kinds = {row.kind: row for row in status.endpoints}
        assert kinds["publisher"].type == "std_msgs/msg/Int8MultiArray"
        assert (kinds["publisher"].node, kinds["publisher"].matched) == ("/tester", 1)
        assert {row.pid for row in status.endpoints} == {process.pid} == {os.getpid()}
        with pytest.raises(transport.TransportError, match="/t: the publisher is closed"):
            publisher.publish(np.zeros(1, np.int8))
    with pytest.raises(transport.TransportError, match=f"tester has left platform '{platform}'"):
        member.publisher("/t", np.int8)
    member.close()
    assert not leftovers(platform)


def test_a_message_outlives_its_subscription(member: transport.Member, ends: Ends) -> None:
    publisher, subscription = ends
    publisher.publish(np.ones(1000, np.float32))
    message = subscription.take(TIMEOUT_S)
    subscription.close()
    member.close()
    assert message.array.sum() == 1000
    message.release()


def test_the_environment_chooses_the_place(platform: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in (("PLATFORM", platform), ("CLUSTER", "3"), ("CORE", "2"), ("WAIT", "spin")):
        monkeypatch.setenv(f"MANYCORE_{name}", value)
    with transport.join() as member:
        assert (member.platform, member.cluster, member.core) == (platform, 3, 2)
    for name, value in (("CLUSTER", "0"), ("CORE", "-1"), ("WAIT", "later"), ("PLATFORM", "a/b")):
        monkeypatch.setenv(f"MANYCORE_{name}", value)
        with pytest.raises(manycore.ManycoreError, match=f"MANYCORE_{name}: expected .*{value}"):
            transport.join()
        monkeypatch.delenv(f"MANYCORE_{name}")


def test_a_process_has_one_place_on_a_platform(member: transport.Member) -> None:
    with transport.join(member.platform, name="again") as again:
        assert again.cluster == 1
    with pytest.raises(transport.TransportError, match=r"joined platform .* in cluster 1 already"):
        transport.join(member.platform, cluster=2)


def test_a_platform_that_is_missing(platform: str) -> None:
    with pytest.raises(transport.TransportError, match=f"no platform '{platform}' to join"):
        transport.join(platform, create=False)
    with pytest.raises(manycore.ManycoreError, match=f"no platform '{platform}'"):
        manycore.status(platform)
    assert not leftovers(platform)
    with transport.join(platform), transport.join(platform, create=False):
        assert platform in manycore.platforms()


BAD_JOINS: list[tuple[dict[str, Any], str]] = [
    ({"platform": "../x"}, r"platform: expected a platform name .* found '\.\./x'"),
    ({"platform": "p" * 65}, "platform: expected a platform name of up to 64 letters"),
    ({"cluster": 0}, "cluster: expected a whole number from 1 to 64, found 0"),
    ({"cluster": "1"}, "cluster: expected a whole number from 1 to 64, found '1'"),
    ({"cluster": 64}, "there is no cluster 64 on platform"),
    ({"core": -1}, "core: expected a whole number from 0 to 1023, found -1"),
    ({"core": 1000}, "there is no core 1000 on platform"),
    ({"name": "no name"}, "name: expected letters, digits and '_', .* found 'no name'"),
    ({"name": "n" * 256}, "name: expected at most 255 characters, found 256"),
]


@pytest.mark.parametrize(("arguments", "problem"), BAD_JOINS)
def test_what_is_no_place_is_refused(
    platform: str, arguments: dict[str, Any], problem: str
) -> None:
    with pytest.raises(manycore.ManycoreError, match=problem):
        transport.join(**{"platform": platform, **arguments})


Act = Callable[[transport.Member], object]
BAD_ENDS: list[tuple[Act, str]] = [
    (lambda m: m.publisher("points", np.int8), "topic: expected a full name .* found 'points'"),
    (lambda m: m.publisher("/a b", np.int8), "topic: expected a full name"),
    (lambda m: m.publisher("/" + "t" * 247, np.int8), "at most 247 characters, found 248"),
    (lambda m: m.subscription("/t", np.dtype("f2")), "dtype: expected one of int8, .* found"),
    (lambda m: m.publisher("/t", np.int8, qos=0), "depth: expected a whole number from 1"),
    (
        lambda m: m.publisher("/t", np.int8, qos=transport.Qos(reliability="perfect")),
        "reliability: expected 'best_effort' or 'reliable', found 'perfect'",
    ),
    (
        lambda m: m.publisher("/t", np.int8, qos=transport.Qos(deadline_ns=-1)),
        "deadline_ns: expected a whole number from 1",
    ),
    (
        lambda m: m.publisher("/t", np.int8).publish(np.zeros(3)),
        r"array: expected elements of int8 on /t \(array\.astype\('int8'\)\), found float64",
    ),
    (
        lambda m: m.publisher("/t", np.int8).publish([1]),  # type: ignore[arg-type]
        "array: expected a numpy array, found list",
    ),
    (
        lambda m: m.publisher("/t", np.int8).publish(np.array(1, np.int8)),
        r"array: expected 1 to 32 dimensions, found shape \(\)",
    ),
    (lambda m: m.subscription("/t", np.int8).take(-1), "timeout_s: expected seconds from 0"),
    (lambda m: m.subscription("/t", np.int8).take(float("nan")), "timeout_s: expected seconds"),
]


@pytest.mark.parametrize(("act", "problem"), BAD_ENDS)
def test_what_is_no_argument_is_refused(member: transport.Member, act: Act, problem: str) -> None:
    with pytest.raises(transport.TransportError, match=problem):
        act(member)


def test_an_array_that_does_not_fit_is_refused(platform: str) -> None:
    shape = {"clusters": 1, "cores_per_cluster": 1, "smem_bytes": 8 << 20}
    cpus: dict[int, int] = {}
    with (
        Configurator(platform, **shape, host_cpu_of_receive_thread=cpus, topics=[]),
        transport.join(platform, name="tester") as member,
    ):
        publisher = member.publisher("/huge", np.uint8)
        size = manycore.status(platform).clusters[0].smem_bytes
        huge = np.broadcast_to(np.zeros(1, np.uint8), (size + 1,))
        with pytest.raises(transport.TransportError) as found:
            publisher.publish(huge)
        assert re.search(rf"{size}|SMEM", str(found.value)), found.value


def test_status_of_what_was_published(ends: Ends, member: transport.Member) -> None:
    publisher, subscription = ends
    for _ in range(3):
        publisher.publish(np.zeros(10, np.float32))
    subscription.take_copy(TIMEOUT_S)
    status = manycore.status(member.platform)
    assert (status.name, status.alive, status.nodes) == (member.platform, True, ("/tester",))
    rows = {row.kind: row for row in status.endpoints}
    assert (rows["publisher"].messages, rows["publisher"].bytes) == (3, 3 * (32 + 40))
    reader = rows["subscription"]
    assert (reader.messages, reader.lost, reader.superseded) == (1, 0, 2)
    assert status.losses == ()
    wait_until(
        lambda: manycore.status(member.platform).clusters[0].receive_thread_pid,
        "the receive thread runs",
    )
