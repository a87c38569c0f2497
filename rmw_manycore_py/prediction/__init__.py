# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Predicts how an application runs at other places, from its profile."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.errors.missing_library import SIMPY, require
from rmw_manycore_py.prediction.prediction import Prediction
from rmw_manycore_py.prediction.sites import Site, Sites, sites_of
from rmw_manycore_py.prediction.target import TARGETS, Target

if TYPE_CHECKING:
    from rmw_manycore_py.profile.model import Profile
    from rmw_manycore_py.trace.chains import Chain

__all__ = ["TARGETS", "Prediction", "Site", "Sites", "Target", "predict", "sites_of"]


def predict(
    sites: Sites,
    profile: Profile,
    target: Target,
    *,
    seed: int = 0,
    duration_s: float = 60.0,
    chains: Sequence[Chain] | None = None,
    is_traced: bool = False,
    timers_together: bool = False,
) -> Prediction:
    """Simulate a run of a profile's application.

    :param sites: places of its nodes; `sites_of(placement)` returns those of a mapfile.
    :param chains: topics of the chains to evaluate; default: all causal chains.
    :param is_traced: whether the prediction has a trace; that of many nodes is large.
    :param timers_together: all timers start at the begin, not each at a time of its own.
    :raises ManycoreError: if the sites lack a node of the profile, nothing in it ran, or SimPy is
        not installed.
    """
    require(SIMPY)
    from rmw_manycore_py.prediction.application import application_of
    from rmw_manycore_py.prediction.attribution import attributed
    from rmw_manycore_py.prediction.outcome import outcome_of
    from rmw_manycore_py.prediction.simulation import Simulation

    application = application_of(attributed(profile))
    if not application.executors:
        raise ManycoreError("the profile has no callback that ran", EXIT_BAD_INPUT)
    simulation = Simulation(application, sites, target, seed, is_traced, timers_together)
    simulation.run(duration_s)
    return outcome_of(simulation, duration_s, chains, is_traced)
