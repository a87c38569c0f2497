# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The order of simulated mappings. Does not prove that the simulation is right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from rmw_manycore_py.advice.problem import Problem, Room, Unit
from rmw_manycore_py.advice.ranking import Candidate, Ranked, Trial, ranked
from rmw_manycore_py.mapfile import Placement, load_mapfile, resolve
from rmw_manycore_py.mapfile.installed import find_mapfile
from rmw_manycore_py.prediction import TARGETS, Prediction
from rmw_manycore_py.prediction.prediction import ChainTimes
from rmw_manycore_py.profile.model import Profile

pytestmark = pytest.mark.unit

PROBLEM = Problem((Unit("n", 1, None, 0.1, 1),), (Room(1, (1,), 100),), (), ())


@pytest.fixture(scope="module")
def placement() -> Placement:
    path = find_mapfile("talker_listener")
    assert path is not None
    return resolve(load_mapfile(Path(path)), to_start=False)


@dataclass(frozen=True)
class Simulated(Trial):
    """Has simulated already: the runs of the candidates, in their order."""

    runs: list[Prediction] = field(default_factory=list)

    def predict(self, placement: Placement) -> Prediction:
        return self.runs.pop(0)


def run(times_us: Mapping[str, tuple[float, ...]]) -> Prediction:
    chains = tuple(ChainTimes(name, samples) for name, samples in times_us.items())
    return Prediction(TARGETS["host"], 1.0, chains, (), (), (), {}, (), (), (), {}, (), 0, None)


def order(placement: Placement, **runs: Mapping[str, tuple[float, ...]]) -> list[Ranked]:
    found = [Candidate(name, (1,), "", placement, is_best=False) for name in runs]
    trial = Simulated(
        Profile.model_construct(),
        TARGETS["host"],
        "p99",
        (),
        1.0,
        0,
        [run(times) for times in runs.values()],
    )
    return ranked(PROBLEM, found, trial)


def test_a_mapping_in_which_a_chain_is_incomplete_comes_last(placement: Placement) -> None:
    found = order(
        placement,
        stuck={"a": (1.0,), "b": ()},
        slow={"a": (9.0,), "b": (9.0,)},
        other={"a": (2.0,)},
    )
    assert [(one.candidate.name, one.incomplete) for one in found] == [
        ("slow", ()),
        ("stuck", ("b",)),
        ("other", ("b",)),
    ]


def test_a_chain_that_no_mapping_completes_does_not_count(placement: Placement) -> None:
    found = order(placement, slow={"a": (9.0,), "b": ()}, fast={"a": (3.0,), "b": ()})
    assert [(one.candidate.name, one.score) for one in found] == [("fast", 1.0), ("slow", 3.0)]
