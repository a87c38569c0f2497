# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Conversion of QoS to and from the transport."""

from __future__ import annotations

import pytest

from rmw_manycore_py.native._transport import Qos
from rmw_manycore_py.ros.qos import Policies, policies_of

pytestmark = pytest.mark.unit

OTHERS: Policies = {
    "reliability": "best_effort",
    "durability": "transient_local",
    "history": "keep_all",
    "depth": 3,
    "deadline_ns": 1,
    "lifespan_ns": 2,
    "liveliness": "manual_by_topic",
    "liveliness_lease_ns": 3,
}


def test_the_defaults_are_those_of_ros() -> None:
    assert policies_of(Qos()) == {
        "reliability": "reliable",
        "durability": "volatile",
        "history": "keep_last",
        "depth": 10,
        "deadline_ns": None,
        "lifespan_ns": None,
        "liveliness": "automatic",
        "liveliness_lease_ns": None,
    }


def test_every_policy_is_kept_and_compared() -> None:
    assert policies_of(Qos(**OTHERS)) == OTHERS
    assert Qos(**OTHERS) == Qos(**OTHERS)
    for policy, value in OTHERS.items():
        changed = Qos(**{policy: value})
        assert changed != Qos(), policy
        assert policies_of(changed) == {**policies_of(Qos()), policy: value}


def test_a_word_that_no_policy_has() -> None:
    words = r"^reliability: expected 'best_effort' or 'reliable', found 'sometimes'$"
    with pytest.raises(ValueError, match=words):
        Qos(reliability="sometimes")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        Qos(colour="red")  # type: ignore[call-arg]


def test_an_endpoints_qos_cannot_be_changed() -> None:
    with pytest.raises(AttributeError):
        Qos().depth = 1  # type: ignore[misc]
