# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Files of profiles: whole, of another version, damaged."""

from __future__ import annotations

import json
from array import array
from pathlib import Path

import pytest

from rmw_manycore_py.errors import FileError, ManycoreError
from rmw_manycore_py.profile.distributions import SHARES, distribution_of, intervals_of
from rmw_manycore_py.profile.files import load, save, to_text
from rmw_manycore_py.profile.model import (
    FORMAT,
    VERSION,
    Callback,
    Coverage,
    Node,
    Process,
    Profile,
)
from rmw_manycore_py.profile.summary import summary_of

pytestmark = pytest.mark.unit


@pytest.fixture
def profile() -> Profile:
    callback = Callback(
        kind="timer", node=0, trigger="", subscription=None, period_ns=1000, symbol='f("a")',
        process=0, threads=(0, 1), group=None, executions=4, rate_hz=2.0,
        wall_ns=distribution_of(array("q", [1, 2, 3, 10])), cpu_ns=None,
        interval_ns=intervals_of(array("q", [30, 10, 15])), publishes=(),
    )  # fmt: skip
    return Profile(
        format=FORMAT, version=VERSION, source="ros2_tracing", events=9, duration_ns=2_000_000_000,
        quantile_shares=SHARES, processes=(Process(name="p", threads=2),),
        nodes=(Node(name="/n", process=0),), publishers=(), subscriptions=(), executors=(),
        groups=(), callbacks=(callback,), chains=(), coverage=Coverage(unfinished=1),
    )  # fmt: skip


def test_a_saved_profile_is_read_as_it_was(profile: Profile, tmp_path: Path) -> None:
    path = tmp_path / "app.profile.json"
    save(profile, path)
    assert load(path) == profile
    assert json.loads(path.read_text())["version"] == 1
    assert list(tmp_path.iterdir()) == [path]


def test_distributions_keep_extremes_and_mean(profile: Profile) -> None:
    wall_ns = profile.callbacks[0].wall_ns
    assert wall_ns is not None
    assert (wall_ns.count, wall_ns.mean) == (4, 4.0)
    quantiles = dict(zip(SHARES, wall_ns.quantiles, strict=True))
    assert (quantiles[0.0], quantiles[0.5], quantiles[1.0]) == (1.0, 2.5, 10.0)
    interval_ns = profile.callbacks[0].interval_ns
    assert interval_ns is not None
    assert (interval_ns.count, interval_ns.quantiles[0], interval_ns.mean) == (2, 5.0, 10.0)


def test_load_counts_cpu_time_before_wall_time(profile: Profile) -> None:
    (callback,) = profile.callbacks
    assert callback.load_cpus == pytest.approx(8e-9)
    measured = callback.model_copy(update={"cpu_ns": distribution_of(array("q", [1]))})
    assert measured.load_cpus == pytest.approx(2e-9)
    assert (callback.cpu_share, measured.cpu_share) == (None, 0.25)
    assert summary_of(profile)["cpus_busy"] == pytest.approx(8e-9)


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"version": 2}, "version: expected 1, found 2 of manycore profile"),
        ({"format": "other"}, "version: expected 1, found 1 of other"),
        ({"events": -1}, "events: expected the profile of an application, found .*greater"),
        ({"extra": 1}, "extra: expected the profile of an application, found Extra"),
        ({"nodes": [{"name": 3}]}, "nodes.0.name: expected the profile"),
        ({"nodes": []}, r"node: expected a position in nodes, which has 0, found \d"),
        ({"quantile_shares": [0.0, 1.0]}, "quantiles: expected 2 values, as quantile_shares"),
        ({"quantile_shares": []}, r"quantile_shares: expected shares .* found \[\]"),
        ({"quantile_shares": [0.5, 0.5]}, "quantile_shares: expected shares from 0 to 1, ascend"),
    ],
)
def test_a_file_of_another_kind_is_refused(
    profile: Profile, tmp_path: Path, change: dict[str, object], error: str
) -> None:
    path = tmp_path / "app.profile.json"
    path.write_text(json.dumps({**json.loads(to_text(profile)), **change}))
    with pytest.raises(FileError, match=error):
        load(path)


def test_a_damaged_or_missing_file_is_refused(profile: Profile, tmp_path: Path) -> None:
    path = tmp_path / "app.profile.json"
    with pytest.raises(ManycoreError, match="cannot be read: No such file"):
        load(path)
    path.write_text(to_text(profile)[:-20])
    with pytest.raises(FileError, match="expected the profile of an application, found Invalid"):
        load(path)
    with pytest.raises(ManycoreError, match="cannot be written"):
        save(profile, tmp_path / "missing" / "app.profile.json")
