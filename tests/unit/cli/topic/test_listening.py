# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How subscribing tools find out type and QoS."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rmw_manycore_py.cli.common.interface_types import load_type
from rmw_manycore_py.cli.topic.listening import offered_policies, type_of_topic
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.native import _transport
from rmw_manycore_py.native.enums import Durability, Reliability

pytestmark = pytest.mark.unit


def publisher(reliability: Reliability, durability: Durability) -> Any:
    qos = _transport.Qos(reliability=reliability, durability=durability)
    return SimpleNamespace(kind="publisher", qos=qos)


def of_type(type_name: str) -> Any:
    return SimpleNamespace(type=type_name)


def test_the_type_is_the_one_in_use() -> None:
    assert type_of_topic("/t", [of_type("a/msg/A"), of_type("a/msg/A")]) == "a/msg/A"
    with pytest.raises(ManycoreError, match="give its type"):
        type_of_topic("/t", [])
    with pytest.raises(ManycoreError, match="did you mean '/talk'"):
        type_of_topic("/talkk", [], ["/list", "/talk"])
    with pytest.raises(ManycoreError, match="a/msg/A, a/msg/B"):
        type_of_topic("/t", [of_type("a/msg/B"), of_type("a/msg/A")])


def test_types_that_are_not_there() -> None:
    assert load_type("std_msgs/msg/String").__name__ == "String"
    with pytest.raises(ManycoreError, match="not installed"):
        load_type("no_such_msgs/msg/Thing")
    with pytest.raises(ManycoreError, match="did you mean 'std_msgs/msg/String'"):
        load_type("std_msgs/msg/Stringg")
    with pytest.raises(ManycoreError, match="expected package/msg/Name"):
        load_type("String")
    assert load_type("std_srvs/SetBool", "srv").__name__ == "SetBool"
    with pytest.raises(ManycoreError, match="expected package/srv/Name"):
        load_type("std_msgs/msg/String", "srv")


def test_no_more_is_asked_for_than_all_publishers_offer() -> None:
    assert offered_policies([]) == (None, None)
    latched = publisher("reliable", "transient_local")
    assert offered_policies([latched]) == (True, True)
    assert offered_policies([latched, publisher("reliable", "volatile")]) == (True, False)
    assert offered_policies([latched, publisher("best_effort", "volatile")]) == (False, False)
