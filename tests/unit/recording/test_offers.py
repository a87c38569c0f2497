# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""QoS profiles in recordings."""

from __future__ import annotations

import pytest
import yaml
from rosbags.rosbag2.metadata import parse_qos

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.recording.offers import offers_in, profiles_text

pytestmark = [pytest.mark.unit, pytest.mark.needs("rosbags")]

SECOND_NS = 1_000_000_000
LATCHED = Qos(
    reliability="best_effort",
    durability="transient_local",
    depth=7,
    deadline_ns=2 * SECOND_NS + 5,
    lifespan_ns=SECOND_NS,
    liveliness="manual_by_topic",
    liveliness_lease_ns=3 * SECOND_NS,
)
NUMBERS = """
- {history: 1, depth: 7, reliability: 2, durability: 1, deadline: {sec: 2, nsec: 5},
   lifespan: {sec: 1, nsec: 0}, liveliness: 3, liveliness_lease_duration: {sec: 3, nsec: 0},
   avoid_ros_namespace_conventions: false}
"""
# As Fast DDS reports the QoS of others, with the infinite durations of Foxy.
UNKNOWN = """
- {history: 3, depth: 0, reliability: 1, durability: 2,
   deadline: {sec: 2147483647, nsec: 4294967295}, lifespan: {sec: 0, nsec: 0}, liveliness: 1,
   liveliness_lease_duration: {sec: 9223372036, nsec: 854775807},
   avoid_ros_namespace_conventions: false}
"""


@pytest.mark.parametrize("qos", [Qos(), LATCHED, Qos(history="keep_all")])
def test_what_is_written_is_read(qos: Qos) -> None:
    assert offers_in(profiles_text([qos, Qos()])) == [qos, Qos()]


def test_a_foreign_reader_finds_the_policies() -> None:
    text = profiles_text([LATCHED])
    assert "&" not in text  # no aliases
    (found,) = parse_qos(text)
    assert (found.reliability.name, found.durability.name) == ("BEST_EFFORT", "TRANSIENT_LOCAL")
    assert (found.history.name, found.depth) == ("KEEP_LAST", 7)
    assert (found.deadline.sec, found.deadline.nsec) == (2, 5)
    assert found.liveliness.name == "MANUAL_BY_TOPIC"


def test_no_limit_is_what_rmw_calls_infinite() -> None:
    (profile,) = yaml.safe_load(profiles_text([Qos()]))
    assert profile["deadline"] == {"sec": 9223372036, "nsec": 854775807}


def test_the_numbers_of_old_recordings_are_read() -> None:
    assert offers_in(NUMBERS) == [LATCHED]
    assert offers_in(UNKNOWN) == [Qos(depth=1)]
    assert offers_in("") == []


@pytest.mark.parametrize("text", ["- 3", "- {history: 1}", "{", "3"])
def test_what_is_no_profile_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="no QoS profiles"):
        offers_in(text)
