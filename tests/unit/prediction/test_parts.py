# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One profile predicts another one's times from publish to callback."""

from __future__ import annotations

import pytest

from rmw_manycore_py.bench.predict.errors import error_of, order_of
from rmw_manycore_py.bench.predict.figures import Figures, Times
from rmw_manycore_py.bench.predict.halves import parts_of
from rmw_manycore_py.bench.predict.runs import Compared
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.profile.model import Distribution, Profile
from support.samples.profiles import MS, pipeline

pytestmark = pytest.mark.unit


def with_queued(ms: float, dispatch_ms: float) -> Profile:
    """Return the pipeline whose messages are under way for this time."""
    queued, dispatch = (
        Distribution(count=100, mean=one * MS, quantiles=(one * MS,) * 3)
        for one in (ms, dispatch_ms)
    )
    profile = pipeline()
    callbacks = tuple(
        one.model_copy(
            update={
                "dispatch_ns": dispatch,
                "queued_ns": queued if one.trigger else None,
                "wall_ns": Distribution(count=1, mean=MS, quantiles=(MS, MS, MS)),
                "interval_ns": None,
                "publishes": tuple(
                    out.model_copy(update={"offset_ns": None}) for out in one.publishes
                ),
            }
        )
        for one in profile.callbacks
    )
    publishers = tuple(
        one.model_copy(update={"size_bytes": None, "interval_ns": None})
        for one in profile.publishers
    )
    return pipeline(callbacks=callbacks, publishers=publishers, quantile_shares=(0.0, 0.5, 1.0))


def test_the_first_part_predicts_the_second() -> None:
    found = parts_of(with_queued(3.0, 2.0), with_queued(2.5, 2.5), 10.0, 1).queueing
    assert found.subscriptions == 2
    assert found.error == pytest.approx(0.2, abs=0.01)  # 2 ms of an idle thread, measured 2.5
    assert found.repeated == pytest.approx(0.2, abs=0.01)


def with_age(profile: Profile, ms: float) -> Profile:
    """Return the profile with this age of what comes to the sink."""
    age = Distribution(count=100, mean=ms * MS, quantiles=(ms * MS,) * 3)
    ages = {"/small": age}
    callbacks = tuple(
        one.model_copy(update={"age_ns": ages.get(one.trigger, one.queued_ns)})
        for one in profile.callbacks
    )
    return profile.model_copy(update={"callbacks": callbacks})


def test_chains_are_compared_from_their_first_publication() -> None:
    """Camera to sink: 2 ms, the filter's 1 ms, 2 ms; 6.25 ms are measured."""
    first, second = with_queued(2.5, 2.0), with_queued(2.5, 2.5)
    chains = parts_of(with_age(first, 6.0), with_age(second, 6.25), 10.0, 1).chains
    assert chains is not None
    assert (chains.subscriptions, chains.only_in_second) == (1, 0)
    assert chains.error == pytest.approx(0.2, abs=0.01)
    assert chains.repeated == pytest.approx(0.04, abs=0.01)
    assert parts_of(first, second, 10.0, 1).chains is None


def test_parts_without_times_are_refused() -> None:
    with pytest.raises(ManycoreError, match="no subscription in common"):
        parts_of(with_queued(1, 1), with_queued(1, 1).model_copy(update={"callbacks": ()}), 1, 1)


def figures(p50_us: float, load: float = 0.3) -> Figures:
    return Figures(
        chains={"chain": Times(count=100, p50_us=p50_us, p99_us=2 * p50_us, max_us=3 * p50_us)},
        cpus={0: load},
    )


def test_errors_are_against_the_median_of_the_runs() -> None:
    runs = [figures(90), figures(100), figures(400, load=0.7)]
    error = error_of(Compared(0, runs, figures(110, load=0.34)))
    assert error.p50 == pytest.approx((0.1,))
    assert error.p99 == pytest.approx((0.1,))
    repeated = (250 / 90 - 1, 245 / 100 - 1, 95 / 400 - 1)
    assert error.repeated_p50 == pytest.approx(repeated)
    assert error.repeated_p99 == pytest.approx(repeated)
    assert error.load_points == pytest.approx(4)
    assert error.is_light


def test_only_pairs_whose_intervals_are_apart_count() -> None:
    """Three mappings: the second overlaps both others."""
    mappings = [
        Compared(0, [figures(10), figures(20)], figures(15)),
        Compared(1, [figures(15), figures(35)], figures(50)),
        Compared(2, [figures(30), figures(40)], figures(35)),
    ]
    assert (order_of(mappings).pairs, order_of(mappings).tau) == (1, 1.0)
    wrong = [mappings[0], Compared(2, mappings[2].runs, figures(12))]
    assert order_of(wrong).tau == -1.0
    assert order_of(mappings[:2]).tau is None
