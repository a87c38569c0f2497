# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""From mapfile and profile to an advised mapfile."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from rmw_manycore_py.advice.application import Application
from rmw_manycore_py.advice.conflict import conflict_in
from rmw_manycore_py.advice.constraints import constraints_of
from rmw_manycore_py.advice.infeasible import InfeasibleError
from rmw_manycore_py.advice.places import places_of
from rmw_manycore_py.advice.problem import Clusters, ConstraintKind, Problem
from rmw_manycore_py.advice.ranking import NOW, Candidate, Ranked, Trial, ranked
from rmw_manycore_py.advice.rewriting import rewritten
from rmw_manycore_py.advice.solving import Effort, candidates
from rmw_manycore_py.advice.weights import Objective
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.errors.missing_library import ORTOOLS, SIMPY, require
from rmw_manycore_py.mapfile import Mapfile, load_mapfile, resolve
from rmw_manycore_py.mapfile.placing.moves import RoomError
from rmw_manycore_py.platform.topology import usable_cpus
from rmw_manycore_py.prediction import TARGETS, Target
from rmw_manycore_py.profile.model import Profile

Report = Callable[[str], None]


@dataclass(frozen=True)
class Request:
    """A request for advice.

    :param chain: topics of the chain that matters; empty: all chains count alike.
    :param wishes: kind and text of constraints.
    :param in_real_time: whether nodes of that chain may have real-time priorities on a host.
    :param target: where mappings are simulated; None: the mapfile's platform.
    :param duration_s: simulated time of each candidate.
    """

    objective: Objective = "p99"
    chain: tuple[str, ...] = ()
    wishes: tuple[tuple[ConstraintKind, str], ...] = ()
    effort: Effort = field(default_factory=Effort)
    in_real_time: bool = True
    duration_s: float = 10.0
    target: Target | None = None

    def target_of(self, mapfile: Mapfile) -> Target:
        """Return where mappings are simulated."""
        topology = mapfile.topology
        return self.target or TARGETS["host" if topology.is_machine else topology.profile]


@dataclass(frozen=True)
class Advice:
    """An advised mapping.

    :param ranking: all candidates, the best first.
    """

    problem: Problem
    application: Application
    ranking: Sequence[Ranked]

    @property
    def best(self) -> Ranked:
        """The best of the candidates."""
        return self.ranking[0]

    @property
    def before(self) -> Ranked | None:
        """The mapping of the mapfile, if it is feasible."""
        return next((one for one in self.ranking if one.candidate.name == NOW), None)


def advise(
    path: Path, text: str, profile: Profile, request: Request, report: Report = lambda _: None
) -> Advice:
    """Return the best mapping that was found for a mapfile.

    :param path: where the new mapfile will be.
    :param text: of the mapfile.
    :raises InfeasibleError: if no mapping keeps all limits.
    :raises MapfileError: if the mapfile has other problems.
    :raises ManycoreError: for a profile of another application, or if a library is missing.
    """
    require(ORTOOLS)
    require(SIMPY)
    mapfile = load_mapfile(path, text=text)
    application = application_of(mapfile, profile)
    problem = application.problem(request.chain)
    problem = replace(problem, constraints=constraints_of(problem, request.wishes))
    found = [*_candidates(path, text, mapfile, problem, request, report)]
    if not found:
        raise InfeasibleError(problem, mapfile.topology, conflict_in(problem, request.effort))
    trial = Trial(
        profile,
        request.target_of(mapfile),
        request.objective,
        request.chain,
        request.duration_s,
        request.effort.seed,
    )
    return Advice(problem, application, ranked(problem, found, trial, report))


def application_of(mapfile: Mapfile, profile: Profile) -> Application:
    """Return mapfile and profile, also if its nodes have no room where they are."""
    try:
        placement = resolve(mapfile, to_start=False)
    except RoomError as error:
        return Application(mapfile, error.advice.placed.nodes, None, profile)
    return Application(mapfile, placement.nodes, placement.bridge, profile)


def _candidates(
    path: Path, text: str, mapfile: Mapfile, problem: Problem, request: Request, report: Report
) -> Iterator[Candidate]:
    """Yield the mapping of the mapfile if it is feasible, then those that were found.

    :raises MapfileError: if the mapfile has problems that other places do not solve.
    """
    is_shared = request.target_of(mapfile).cpus == "host" and not mapfile.topology.is_machine
    cpus = usable_cpus() if is_shared else ()
    with_priorities = (False, True) if request.in_real_time and cpus and problem.hot else (False,)
    if not [*problem.broken(problem.now)]:
        placement = resolve(mapfile, to_start=False)
        yield Candidate(NOW, problem.now, text, placement, is_best=False)
    seen: set[Clusters] = set()
    refused: list[MapfileError] = []
    for found in candidates(problem, request.objective, request.effort, report):
        if found.clusters in seen:
            continue
        seen.add(found.clusters)
        for in_real_time in with_priorities:
            places = places_of(problem, found.clusters, cpus, in_real_time=in_real_time)
            changed = rewritten(text, places)
            try:
                placement = resolve(load_mapfile(path, text=changed), to_start=False)
            except MapfileError as error:  # such as too many sessions, which no variable has
                refused.append(error)
                continue
            name = f"{found.emphasis.name}{', in real time' if in_real_time else ''}"
            yield Candidate(name, found.clusters, changed, placement, found.is_best)
    if refused and len(refused) == len(seen) * len(with_priorities):
        raise refused[0]
