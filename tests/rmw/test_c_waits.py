# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Return codes of rmw_wait, in C: rclpy treats timeouts and wake-ups alike, rclcpp does not."""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
import rclpy

from support import IS_MANYCORE, TIMEOUT_S
from support.nodes.handles import rcl, rcl_handle, rmw

OK, TIMEOUT = 0, 2


class Handle(ctypes.Structure):
    """The head of rmw_guard_condition_t."""

    _fields_ = (("identifier", ctypes.c_char_p), ("data", ctypes.c_void_p))


class Conditions(ctypes.Structure):
    """rmw_guard_conditions_t."""

    _fields_ = (("count", ctypes.c_size_t), ("conditions", ctypes.POINTER(ctypes.c_void_p)))


class Time(ctypes.Structure):
    _fields_ = (("sec", ctypes.c_uint64), ("nsec", ctypes.c_uint64))


rcl.rcl_context_get_rmw_context.restype = ctypes.c_void_p
rmw.rmw_create_guard_condition.restype = ctypes.POINTER(Handle)
rmw.rmw_create_wait_set.restype = ctypes.c_void_p


@dataclass
class Wait:
    """A context with a wait set that has one guard condition."""

    context: rclpy.Context
    guard: Any
    wait_set: ctypes.c_void_p

    def trigger(self) -> None:
        assert rmw.rmw_trigger_guard_condition(self.guard) == OK

    def __call__(self, timeout: Time | None) -> tuple[int, bool]:
        """Return the code of a wait, and whether the guard condition was ready."""
        data = ctypes.c_void_p(self.guard.contents.data)
        conditions = Conditions(1, ctypes.pointer(data))
        limit = None if timeout is None else ctypes.byref(timeout)
        nothing = (None, None, None)
        code = rmw.rmw_wait(None, ctypes.byref(conditions), *nothing, self.wait_set, limit)
        return code, data.value is not None


@pytest.fixture
def wait() -> Iterator[Wait]:
    context = rclpy.Context()
    context.init()
    with context.handle:
        own = ctypes.c_void_p(rcl.rcl_context_get_rmw_context(rcl_handle(context)))
        guard = rmw.rmw_create_guard_condition(own)
        wait_set = ctypes.c_void_p(rmw.rmw_create_wait_set(own, ctypes.c_size_t(1)))
        yield Wait(context, guard, wait_set)
        assert rmw.rmw_destroy_wait_set(wait_set) == OK
        assert rmw.rmw_destroy_guard_condition(guard) == OK
    context.try_shutdown()


def test_a_timeout_is_reported_when_it_has_passed(wait):
    assert wait(Time()) == wait(Time(0, 1000)) == (TIMEOUT, False)
    wait.trigger()
    assert wait(Time()) == (OK, True)
    assert wait(Time()) == (TIMEOUT, False)


@pytest.mark.skipif(not IS_MANYCORE, reason="Fast DDS goes on waiting")
@pytest.mark.parametrize("timeout", [None, Time(3600, 0)], ids=["endless", "an_hour"])
def test_a_wait_that_its_context_ends_does_not_say_timeout(wait, timeout):
    """rclcpp's graph listener waits without a timeout, and throws if the wait returns TIMEOUT."""
    answers = []
    thread = threading.Thread(target=lambda: answers.append(wait(timeout)), daemon=True)
    thread.start()
    wait.context.shutdown()
    thread.join(TIMEOUT_S)
    assert answers == [(OK, False)]
    assert wait(timeout) == (OK, False)  # started after the end of the context
