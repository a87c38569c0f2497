# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Relations of the thesis: held against times, and told apart as derived or fitted."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import pytest

from rmw_manycore_py.bench.relations import Claim, Found, measured_relations, side
from rmw_manycore_py.papers.thesis.matrix import claims as matrix
from rmw_manycore_py.papers.thesis.matrix.cases import Case as Product
from rmw_manycore_py.papers.thesis.noc import claims as noc
from rmw_manycore_py.papers.thesis.noc.cases import Case, Setting

pytestmark = pytest.mark.unit

MIDDLE: Claim[int] = Claim(
    "L", "it is 4 to 6", lambda n: (side(n, min_value=4, max_value=6), str(n))
)


@pytest.mark.parametrize(
    ("default", "others", "holds", "basis"),
    [
        (6, [4, 5], True, "derived"),
        (6, [5, 1], True, "fitted"),
        (1, [2, 3], False, "derived"),
        (1, [2, 5], False, "fitted"),
        (1, [2, 7], False, "fitted"),  # between them it holds
        (5, [1, 2], True, "fitted"),  # but nowhere else
    ],
)
def test_what_holds_for_all_parameters_is_derived(
    default: int, others: list[int], holds: bool, basis: str
) -> None:
    found = MIDDLE.modelled(default, others)
    assert (found.holds, found.basis) == (holds, basis)
    assert found.in_words == ("holds here" if holds else "does not hold here")


def test_what_was_not_measured_is_left_out() -> None:
    def missing(_: int) -> Found:
        raise KeyError

    found = measured_relations([MIDDLE, Claim("M", "", missing)], 6)
    assert [(relation.name, relation.basis) for relation in found] == [("L", "measured")]


ROUTES = Setting(("direct", "detour"), "direct", "between")


@dataclass
class Transfers:
    """Times as the thesis has them; `changed` breaks one."""

    changed: Callable[[Case, int, float], float] = lambda _case, _size, us: us
    losses: Mapping[str, float] = field(
        default_factory=lambda: {"without flow control": 5, "with credits": 0}
    )
    sizes: tuple[int, ...] = (100, 1_000, 10_000, 100_000, 1_000_000)
    setting: Setting = ROUTES

    def us(self, case: Case, size_bytes: int) -> float:
        per_kb = 0.4 if case.method == "UC" else 4 if case.source == "IO DDR" else 2
        faster = 0.8 if case.source == "CC SMEM" else 1
        return self.changed(case, size_bytes, faster * (2 + per_kb * size_bytes / 1000))

    def lost(self, flow_control: str) -> float:
        return self.losses[flow_control]


def held_of_transfers(times: Transfers) -> set[str]:
    return {r.name for r in measured_relations(noc.CLAIMS, times) if r.holds}


ALL = {f"T{n}" for n in range(1, 8)}


def test_all_hold_for_the_times_of_the_thesis() -> None:
    assert held_of_transfers(Transfers()) == ALL


@pytest.mark.parametrize(
    ("broken", "changed"),
    [
        ("T1", lambda c, size, us: us * (2 if size == 10_000 else 1)),
        ("T2", lambda c, size, us: us * (1.2 if c.route == "detour" else 1)),
        ("T3", lambda c, size, us: us * (12 if c.method == "UC" else 1)),
        ("T4", lambda c, size, us: us / (2 if (c.method, c.source) == ("Tx", "IO DDR") else 1)),
        ("T5", lambda c, size, us: us * (1.2 if (c.method, c.source) == ("UC", "IO DDR") else 1)),
        ("T6", lambda c, size, us: us * (1.3 if c.source == "CC SMEM" else 1)),
    ],
)
def test_a_relation_that_does_not_hold_is_reported(
    broken: str, changed: Callable[[Case, int, float], float]
) -> None:
    assert held_of_transfers(Transfers(changed)) == ALL - {broken}


@pytest.mark.parametrize(("without", "controlled"), [(0, 0), (5, 1)])
def test_overflow_must_be_there_without_flow_control_only(without: int, controlled: int) -> None:
    losses = {"without flow control": without, "with credits": controlled}
    assert held_of_transfers(Transfers(losses=losses)) == ALL - {"T7"}


def test_a_single_size_shows_no_line() -> None:
    found = measured_relations(noc.CLAIMS, Transfers(sizes=(10_000,)))
    assert {r.name for r in found} == ALL - {"T1"}


@dataclass
class Products:
    """Times as the thesis has them; `changed` breaks one."""

    changed: Callable[[Product, float], float] = lambda _case, ms: ms
    losses: Mapping[str, float] = field(default_factory=lambda: {"IO DDR": 7, "IO SMEM": 0})
    sizes: tuple[int, ...] = (280, 400)
    free_cores: int = 64

    def ms(self, case: Product) -> float:
        work = (case.n / 280) ** 3 * 100
        if case.place.startswith("off-load"):
            return self.changed(case, 2 + 0.2 * work / case.threads)
        slower = {"IO DDR": 4.0, "IO SMEM": 1.5, "CC SMEM": 0.9}[case.place]
        return self.changed(case, work * (1 if case.is_cached else slower) / case.threads)

    def lost(self, place: str) -> float:
        return self.losses[place]


def held_of_products(times: Products) -> set[str]:
    return {r.name for r in measured_relations(matrix.CLAIMS, times) if r.holds}


ALL_OF_MATRIX = {claim.name for claim in matrix.CLAIMS}


def test_all_hold_for_the_products_of_the_thesis() -> None:
    assert held_of_products(Products()) == ALL_OF_MATRIX


@pytest.mark.parametrize(
    ("broken", "changed"),
    [
        (
            {"M1", "M2", "M3b", "M4"},
            lambda c, ms: (
                ms
                / (6 if c.place == "IO DDR" and c.is_cached else 1)
                / (c.n / 280 if c.place == "IO DDR" else 1)
            ),
        ),
        ({"M1b"}, lambda c, ms: ms * (1.3 if c.threads > 4 and c.place == "CC SMEM" else 1)),
        (
            {"M2b", "M2c"},
            lambda c, ms: ms * (2 if (c.place, c.is_cached) == ("CC SMEM", False) else 1),
        ),
        ({"M3"}, lambda c, ms: ms * (c.threads if c.place.startswith("off") and c.n == 280 else 1)),
    ],
)
def test_a_product_that_does_not_fit_is_reported(
    broken: set[str], changed: Callable[[Product, float], float]
) -> None:
    held = held_of_products(Products(changed))
    assert not held & broken


def test_what_smem_loses_is_no_overflow_of_ddr() -> None:
    losses = {"IO DDR": 7, "IO SMEM": 1}
    assert held_of_products(Products(losses=losses)) == ALL_OF_MATRIX - {"M5"}


def test_without_free_cores_no_speed_up_is_judged() -> None:
    found = measured_relations(matrix.CLAIMS, Products(free_cores=1))
    assert not {"M1b", "M3"} & {relation.name for relation in found}


def test_the_overhead_is_what_threads_do_not_divide() -> None:
    overhead_ms, error = matrix.fit_overhead([1, 2, 4], [13, 8, 5.5])
    assert overhead_ms == pytest.approx(3)
    assert error == pytest.approx(0, abs=1e-9)
