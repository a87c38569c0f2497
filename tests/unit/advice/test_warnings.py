# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What `map show --profile` says against a mapping."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.profile.files import save
from rmw_manycore_py.profile.model import Profile
from support.samples.profiles import callback, pipeline, publishes

pytestmark = pytest.mark.unit

COMMAND = "command: [sleep, '1'], ros_arguments: false"


def warnings(directory: Path, profile: Profile, clusters: tuple[int, ...], head: str) -> list[str]:
    names = ("camera", "filter", "sink")
    lines = [f"  {n}: {{cluster: {c}, {COMMAND}}}\n" for n, c in zip(names, clusters, strict=True)]
    (directory / "map.yaml").write_text(f"{head}\nnodes:\n{''.join(lines)}")
    save(profile, directory / "app.profile.json")
    words = ["map", "show", str(directory / "map.yaml"), "--json"]
    result = CliRunner().invoke(cli, [*words, "--profile", str(directory / "app.profile.json")])
    assert result.exit_code == 0, result.output
    found: list[str] = json.loads(result.stdout)["warnings"]
    return found


def test_a_good_mapping_has_none(tmp_path: Path) -> None:
    assert warnings(tmp_path, pipeline(), (1, 1, 1), "platform: coolidge") == []


def test_a_node_in_the_wrong_cluster_is_named(tmp_path: Path) -> None:
    assert warnings(tmp_path, pipeline(), (1, 1, 2), "platform: coolidge") == [
        "10.0 messages/s and 9.766 KiB/s cross clusters, 0.0 messages/s and 0 B/s with sink in "
        "cluster 1: `manycore advise` finds more"
    ]


def test_a_full_cluster_is_no_way_out(tmp_path: Path) -> None:
    """Two free cores in each cluster: the third node has to be elsewhere."""
    head = "platform: {profile: coolidge, clusters: 2, cores_per_cluster: 3}"
    assert warnings(tmp_path, pipeline(), (1, 1, 2), head) == []


def test_overload_and_memory(tmp_path: Path) -> None:
    sample = pipeline()
    slow = callback(1, 120, trigger="/image", subscription=0, publishes=publishes(1, 20))
    profile = pipeline(callbacks=(sample.callbacks[0], slow, sample.callbacks[2]))
    head = "platform: {profile: coolidge, smem_size: 256KiB}"
    found = warnings(tmp_path, profile, (1, 1, 1), head)
    assert found[0].endswith("is overloaded: its callbacks take 120% of a CPU of the profile")
    assert found[1].startswith("cluster 1 needs 312 KiB of 223 KiB")
