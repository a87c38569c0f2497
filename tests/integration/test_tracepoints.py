# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The rmw's tracepoints of libtracetools, as ros2_tracing and CARET expect them.

They are seen through a stand-in for libtracetools: there is no LTTng session here.
"""

from __future__ import annotations

import re

import pytest

from support import IS_MANYCORE
from support.processes.commands import example_command
from support.processes.preloaded import preloaded

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="the tracepoints of rmw_manycore"),
]


@pytest.fixture(scope="module")
def tracepoints(tmp_path_factory) -> dict[str, str]:
    return preloaded("tracepoints", tmp_path_factory.mktemp("tracepoints"))


def test_publish_and_take_have_handle_message_and_time(start, tracepoints) -> None:
    listener = start(example_command("listener"), **tracepoints)
    talker = start(example_command("talker"), **tracepoints)
    published = talker.wait_for(r"^publish (\S+) 1 [1-9]\d{17,}$")
    assert published[1] in re.findall(r"^publisher_init (\S+) [1-9]", talker.output, re.M)
    taken = listener.wait_for(r"^take (\S+) 1 [1-9]\d{17,} 1$")
    assert taken[1] in re.findall(r"^subscription_init (\S+) [1-9]", listener.output, re.M)


def test_requests_and_responses_have_handle_client_and_number(start, tracepoints) -> None:
    """The tracepoints that libtracetools has since Kilted."""
    lamp = start(example_command("lamp"), **tracepoints)
    switch = start(example_command("lamp_switch"), **tracepoints)
    sent = switch.wait_for(r"^send_request (\S+) 1 ([1-9]\d*)$")
    assert sent[1] in re.findall(r"^client_init (\S+) [1-9]", switch.output, re.M)
    taken = lamp.wait_for(rf"^take_request (\S+) 1 [1-9]\d* {sent[2]} 1$")
    lamp.wait_for(rf"^send_response {taken[1]} 1 [1-9]\d* {sent[2]} [1-9]\d{{17,}}$")
    switch.wait_for(rf"^take_response {sent[1]} 1 {sent[2]} [1-9]\d{{17,}} 1$")
