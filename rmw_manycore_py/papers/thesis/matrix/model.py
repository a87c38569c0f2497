# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The products in the model of Bostan: cores and caches, and tiles that cross its NoC."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache

from rmw_manycore_py.bench.question import Question, Run
from rmw_manycore_py.bench.relations import Relation, modelled_relations
from rmw_manycore_py.bench.summary import Result
from rmw_manycore_py.papers.thesis.matrix.cases import IO_DDR, IO_SMEM, LOST, Case, Place
from rmw_manycore_py.papers.thesis.matrix.claims import CLAIMS
from rmw_manycore_py.papers.thesis.matrix.core_time import FLOAT_BYTES, product_cycles
from rmw_manycore_py.papers.thesis.matrix.figures import Draw
from rmw_manycore_py.prediction.bostan import routing
from rmw_manycore_py.prediction.bostan.chip import Traffic
from rmw_manycore_py.prediction.bostan.chip import run as run_chip
from rmw_manycore_py.prediction.bostan.memory import MEMORIES, MemoryKind
from rmw_manycore_py.prediction.bostan.parameters import Parameters, corners
from rmw_manycore_py.prediction.bostan.transfers import FLOW_CONTROLS, FlowControl, Transfer

TILES = 4
CORES = 16
_MEMORIES: dict[Place, MemoryKind] = {kind: kind for kind in MEMORIES}
_DESTINATIONS: tuple[Place, ...] = (IO_DDR, IO_SMEM)


@dataclass(frozen=True)
class ModelTimes:
    """Times in the model with some parameters; each is computed when it is asked for."""

    sizes: tuple[int, ...]
    parameters: Parameters
    free_cores: int = TILES * CORES

    def ms(self, case: Case) -> float:
        """Return the time of a product."""
        return _cycles(case, self.parameters) * self.parameters.cycle_s * 1e3

    def lost(self, place: Place) -> float:
        """Return the packets lost without flow control."""
        return _collect(self.sizes[0], place, _of_transfers(self.parameters), "none").lost_packets


@cache
def _cycles(case: Case, parameters: Parameters) -> float:
    n = case.n
    if kind := _MEMORIES.get(case.place):
        return product_cycles((n, n, n), kind, case.is_cached, case.threads, parameters)
    tile = (-(-n // 2), -(-n // 2), n)
    of_transfers = _of_transfers(parameters)
    return (
        _distribute(n, of_transfers).end
        + product_cycles(tile, "CC SMEM", case.is_cached, case.threads, parameters)
        # C goes to the IO SMEM, as the thesis had to have it.
        + _collect(n, IO_SMEM, of_transfers, "none").end
    )


def _of_transfers(parameters: Parameters) -> Parameters:
    """Return the parameters with those that no transfer by UC depends on as they are by default."""
    default = Parameters()
    return replace(
        parameters,
        multiply_add_cycles=default.multiply_add_cycles,
        line_bytes=default.line_bytes,
    )


@cache
def _distribute(n: int, parameters: Parameters) -> Traffic:
    """Send half of A and half of B to each of four clusters, from DDR and on links of their own."""
    size = 2 * -(-n // 2) * n * FLOAT_BYTES
    routes = [routing.shortest(f"N{number}", f"C{number + 1}") for number in range(TILES)]
    return run_chip([Transfer(route, size, "UC", "IO DDR") for route in routes], parameters)


@cache
def _collect(n: int, place: Place, parameters: Parameters, control: FlowControl) -> Traffic:
    """Send a quarter of C from each of four clusters into a memory of the I/O subsystem."""
    size = (-(-n // 2)) ** 2 * FLOAT_BYTES
    destination = _MEMORIES[place]
    routes = [routing.shortest(f"C{number + 1}", f"N{number}") for number in range(TILES)]
    transfers = [Transfer(route, size, "UC", "CC SMEM", destination) for route in routes]
    return run_chip(transfers, parameters, control)


def question(cases: Sequence[Case], draw: Draw) -> Question:
    """Return the question as it is put to the model."""
    sizes = tuple(sorted({case.n for case in cases}))
    default = ModelTimes(sizes, Parameters())

    def measure(run: Run) -> list[Result]:
        results = []
        for case in cases:
            if run.wants(f"{case.question}: {case.name}"):
                run.note(f"{case.question}: {case.name}")
                samples = (default.ms(case),)
                results.append(Result(case.question, case.name, "ms", samples, curve=case.curve))
        return results + _losses(run, sizes[0])

    def relations(_: object) -> list[Relation]:
        return modelled_relations(
            CLAIMS,
            default,
            lambda names: [ModelTimes(sizes, p) for p in corners(Parameters(), names)],
        )

    return Question("matrix, model of Bostan", measure, (), "none: simulated", relations, draw)


def _losses(run: Run, n: int) -> list[Result]:
    return [
        Result(LOST, name, "packets", (_collect(n, place, Parameters(), control).lost_packets,))
        for place in _DESTINATIONS
        for control_name, control in FLOW_CONTROLS.items()
        if run.wants(f"{LOST}: {(name := f'to {place} {control_name}')}")
    ]
