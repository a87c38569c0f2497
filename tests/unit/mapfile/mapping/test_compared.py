# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Two traces: a line for each chain, and one for what crosses clusters."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import save
from support.samples.traces import example

pytestmark = pytest.mark.unit

MESSAGE_BYTES = 60  # of example()


def manycore(*words: str | Path) -> Result:
    return CliRunner().invoke(cli, [*map(str, words)], prog_name="manycore")


def saved(trace: Trace, path: Path) -> Path:
    save(trace, path)
    return path


def places(**clusters: int) -> Mapping[str, int]:
    return {f"/{name}": cluster for name, cluster in clusters.items()}


def moved(trace: Trace, clusters: Mapping[str, int]) -> Trace:
    """Return the trace of the same messages with nodes in other clusters."""
    endpoints = {
        key: replace(one, cluster=clusters[one.node]) for key, one in trace.endpoints.items()
    }
    return replace(trace, endpoints=endpoints)


def test_compare_has_a_line_for_each_chain_and_one_for_the_mapping(tmp_path: Path) -> None:
    before = moved(example(), places(camera=1, filter=2, sink=3))
    after = moved(example(slower_us=50), places(camera=1, filter=1, sink=2))
    files = [saved(before, tmp_path / "a.json"), saved(after, tmp_path / "b.json")]
    result = manycore("trace", "compare", *files)
    heading, chain, mapping = result.stdout.splitlines()
    assert heading.split() == ["before", "after", "verdict", "chain"]
    assert chain.split()[:5] == ["333.0", "us", "383.0", "us", "slower"]
    assert chain.endswith("/image (/filter) > /small (/sink)")
    assert mapping == (
        "between clusters: 228.1 messages/s and 13.37 KiB/s (100% of all messages) before, "
        "114.0 messages/s and 6.679 KiB/s (50% of all messages) after: less"
    )
    assert manycore("trace", "compare", *reversed(files)).stdout.endswith(": more\n")
    parts = manycore("trace", "compare", "--parts", *files).stdout
    assert "communication /image" in parts
    rows = json.loads(manycore("trace", "compare", "--json", *files).stdout)
    assert {row["part"] for row in rows[:-1]} > {"total", "node /filter"}
    assert rows[-1]["part"] == "between clusters"
    assert rows[-1]["verdict"] == "less"
    counts = {
        key: (rows[-1][key]["messages"], rows[-1][key]["bytes"]) for key in ("before", "after")
    }
    assert counts == {"before": (16, 16 * MESSAGE_BYTES), "after": (8, 8 * MESSAGE_BYTES)}


def test_compare_does_not_depend_on_the_speed_of_the_machine(tmp_path: Path) -> None:
    clusters = places(camera=1, filter=2, sink=2)
    files = [
        saved(moved(example(rounds=8), clusters), tmp_path / "a.json"),
        saved(moved(example(slower_us=900, rounds=80), clusters), tmp_path / "b.json"),
    ]
    assert manycore("trace", "compare", *files).stdout.splitlines()[-1].endswith(": same")
