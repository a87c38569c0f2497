# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Functions called in a helper process."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import pytest

from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.process.helper_process import HelperProcess

pytestmark = pytest.mark.unit


def test_a_helper_calls_functions_beside_this_process():
    helper = HelperProcess("tester", 7)
    assert helper.pid is None
    pid = helper.call(os.getpid)
    assert pid == helper.pid != os.getpid()
    assert helper.call(os.nice, 0) == min(os.nice(0) + 7, 19)
    big = np.arange(300_000.0)
    np.testing.assert_array_equal(helper.call(np.flip, big), big[::-1])
    helper.call(print, "what is printed there is no answer")
    with pytest.raises(ZeroDivisionError):
        helper.call(divmod, 1, 0)
    helper.close()
    with pytest.raises(ManycoreError, match="closed"):
        helper.call(os.getpid)
    assert not Path(f"/proc/{pid}").exists()


def test_a_killed_helper_is_reported_and_replaced():
    helper = HelperProcess("tester", 7)
    pid = helper.call(os.getpid)
    with pytest.raises(ManycoreError, match="the tester process ended unexpectedly"):
        helper.call(os.kill, pid, signal.SIGKILL)
    assert helper.call(os.getpid) not in (pid, os.getpid())
    helper.close()
