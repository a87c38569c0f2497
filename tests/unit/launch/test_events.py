# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events as lines of JSON."""

import json

import pytest

from rmw_manycore_py.launch.events import PlacedCore, Platform, SignalEscalated

pytestmark = pytest.mark.unit


def test_an_event_is_one_line_with_its_kind_first() -> None:
    line = SignalEscalated("talker", "SIGTERM").as_json()
    assert "\n" not in line
    assert json.loads(line) == {"event": "signal_escalated", "node": "talker", "signal": "SIGTERM"}
    assert line.startswith('{"event": ')


def test_what_is_inside_an_event_is_plain_data_too() -> None:
    event = Platform("p", "host", 5, 16, 4096, (PlacedCore("talker", 1, 2, 0),))
    cores = json.loads(event.as_json())["cores"]
    assert cores == [{"node": "talker", "cluster": 1, "core": 2, "host_cpu": 0}]
