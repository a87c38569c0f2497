# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Why no mapping is feasible, and the nearest change that makes one so."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rmw_manycore_py.advice.model import CORES, MEMORY, Model, Slack
from rmw_manycore_py.advice.problem import Problem
from rmw_manycore_py.advice.solving import Effort

if TYPE_CHECKING:
    from ortools.sat.python.cp_model import CpModel

_SECONDS = 10.0  # of each search


@dataclass(frozen=True)
class Conflict:
    """Limits that cannot hold together.

    :param limits: names; without any one of them the others hold.
    :param dropped: wishes of which dropping any one is enough.
    :param more_bytes: that each cluster would need; None where memory alone is not enough.
    :param more_cores: likewise.
    :param all_of: where nothing alone is enough, what is to be given up together.
    """

    limits: tuple[str, ...]
    dropped: tuple[str, ...]
    more_bytes: int | None
    more_cores: int | None
    all_of: tuple[str, ...] = ()


def conflict_in(problem: Problem, effort: Effort) -> Conflict | None:
    """Return the conflict; None if a mapping is feasible or none was found in time."""
    core = _core(problem, effort)
    if core is None:
        return None
    core = _minimal(problem, core, effort)
    dropped = tuple(
        one.text
        for one in problem.constraints
        if one.text in core and _is_feasible(_without(problem, one.text), effort)
    )
    more_bytes = _least(problem, MEMORY, effort) if MEMORY in core else None
    more_cores = _least(problem, CORES, effort) if CORES in core else None
    is_enough = dropped or more_bytes is not None or more_cores is not None
    return Conflict(
        tuple(core),
        dropped,
        more_bytes,
        more_cores,
        () if is_enough else tuple(_fewest(problem, effort)),
    )


def _core(problem: Problem, effort: Effort) -> list[str] | None:
    """Return limits that cannot hold together; None if all of them can, as far as is known.

    The solver's assumptions name few of them. Where it does not get so far, they are all of them.
    """
    from ortools.sat.python import cp_model

    model = Model(problem)
    names = {limit.literal.index: limit.name for limit in model.limits}
    if _holds(problem, [*names.values()], effort) is not False:
        return None
    model.cp.add_assumptions([limit.literal for limit in model.limits])
    solver = effort.solver(_SECONDS)
    solver.parameters.interleave_search = False
    solver.parameters.num_workers = 1  # assumptions are tracked by a single one
    if solver.solve(model.cp) != cp_model.INFEASIBLE:
        return [*names.values()]
    return [names[index] for index in solver.sufficient_assumptions_for_infeasibility()]


def _minimal(problem: Problem, core: list[str], effort: Effort) -> list[str]:
    """Return the limits that remain in conflict when none can be left out."""
    for name in core:
        fewer = [other for other in core if other != name]
        if _holds(problem, fewer, effort) is False:
            core = fewer
    return core


def _holds(problem: Problem, names: Sequence[str], effort: Effort) -> bool | None:
    """Return whether some limits can hold together; None if the search did not find out."""
    from ortools.sat.python import cp_model

    model = Model(problem)
    model.hold([limit for limit in model.limits if limit.name in names])
    status = effort.solver(_SECONDS).solve(model.cp)
    if status == cp_model.UNKNOWN:
        return None
    return status != cp_model.INFEASIBLE


def _is_feasible(problem: Problem, effort: Effort) -> bool:
    model = Model(problem)
    return _holds(problem, [limit.name for limit in model.limits], effort) is True


def _without(problem: Problem, text: str) -> Problem:
    return replace(
        problem, constraints=tuple(one for one in problem.constraints if one.text != text)
    )


def _least(problem: Problem, what: str, effort: Effort) -> int | None:
    """Return how much more of something each cluster needs; None if that is not enough."""
    from ortools.sat.python import cp_model

    def slack(cp: CpModel) -> Slack:
        if what == CORES:
            return Slack(cores=cp.new_int_var(0, len(problem.units), "more cores"))
        total = sum(unit.size_bytes for unit in problem.units)
        landings = sum(flow.landing_bytes * len(problem.rooms) for flow in problem.flows)
        return Slack(size_bytes=cp.new_int_var(0, total + landings, "more bytes"))

    model = Model(problem, slack)
    model.hold(model.limits)
    more = model.slack.cores if what == CORES else model.slack.size_bytes
    model.cp.minimize(more)
    solver = effort.solver(_SECONDS)
    if solver.solve(model.cp) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return solver.value(more)


def _fewest(problem: Problem, effort: Effort) -> Iterator[str]:
    """Yield the fewest limits without which the others hold."""
    model = Model(problem)
    model.cp.maximize(sum(limit.literal for limit in model.limits))
    solver = effort.solver(_SECONDS)
    solver.solve(model.cp)
    yield from (one.name for one in model.limits if not solver.boolean_value(one.literal))
