# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Arrays that are filled in shared memory, and published from there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from rmw_manycore_py import transport
from rmw_manycore_py.transport.multi_array import TYPES
from support import TIMEOUT_S

pytestmark = pytest.mark.integration

Ends = tuple[transport.Publisher[Any], transport.Subscription[Any]]


@pytest.fixture
def member(platform: str) -> Iterator[transport.Member]:
    with transport.join(platform, name="tester") as member:
        yield member


@pytest.fixture
def ends(member: transport.Member) -> Ends:
    """Both ends of a topic that keeps two messages."""
    subscription = member.subscription("/floats", np.float32, qos=2)
    return member.publisher("/floats", np.float32, qos=2), subscription


@pytest.mark.parametrize("dtype", TYPES, ids=str)
@pytest.mark.parametrize("shape", [(3,), (40, 50, 60), (2, 0)], ids=str)
def test_an_array_is_filled_where_it_is_published(
    member: transport.Member, dtype: np.dtype[Any], shape: tuple[int, ...]
) -> None:
    subscription = member.subscription("/arrays", dtype)
    publisher = member.publisher("/arrays", dtype)
    sent = np.arange(np.prod(shape)).astype(dtype).reshape(shape)
    with publisher.lend(shape) as loan:
        assert loan.array.flags.aligned
        loan.array[...] = sent
    assert loan.sequence == 1
    with subscription.take(TIMEOUT_S) as message:
        assert np.array_equal(message.array, sent)
        assert message.array.shape == shape


def test_a_publisher_goes_on_beside_its_loans(ends: Ends) -> None:
    publisher, subscription = ends
    with publisher.lend(20_000) as first, publisher.lend(20_000) as second:
        first.array[:] = 1.0
        second.array[:] = 2.0
        publisher.publish(np.full(20_000, 3.0, np.float32))
        assert subscription.take_copy(TIMEOUT_S)[-1] == 3.0
    assert (second.sequence, first.sequence) == (2, 3)
    assert [subscription.take_copy(TIMEOUT_S)[-1] for _ in range(2)] == [2.0, 1.0]


def test_a_loan_that_fails_publishes_nothing(ends: Ends) -> None:
    publisher, subscription = ends
    with pytest.raises(ZeroDivisionError), publisher.lend(20_000) as loan:
        loan.array[0] = 1 / 0
    assert subscription.try_take() is None
    with pytest.raises(transport.TransportError, match="the loan is over: fill its array inside"):
        _ = loan.array
    assert publisher.publish(np.ones(3, np.float32)) == 1


def test_an_array_that_outlives_its_loan_is_not_published(ends: Ends) -> None:
    publisher, subscription = ends
    with (
        pytest.raises(transport.MessageInUseError, match="still in use, so it is not published"),
        publisher.lend(20_000) as loan,
    ):
        kept = loan.array[:10]
    kept[:] = 1.0
    assert subscription.try_take() is None


@pytest.mark.parametrize("shape", [-1, (2, -1), "x", 1.5, (), None], ids=repr)
def test_a_loan_of_no_shape_is_refused(ends: Ends, shape: Any) -> None:
    with pytest.raises(transport.TransportError, match=r"shape|dimensions"):
        ends[0].lend(shape)
