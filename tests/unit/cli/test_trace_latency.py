# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore trace latency` of traces with few messages."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.trace.events import Trace
from rmw_manycore_py.trace.files import save
from support.samples.traces import example

pytestmark = pytest.mark.unit


def shown(trace: Trace, directory: Path, *words: str) -> str:
    path = directory / "trace.json"
    save(trace, path)
    result = CliRunner().invoke(cli, ["trace", "latency", str(path), *words])
    assert result.exit_code == 0, result.output
    return result.output


def test_a_part_without_samples_has_no_figures(tmp_path: Path) -> None:
    """A single message has no next one, to which a reaction would be measured."""
    trace = example(rounds=1)
    (reaction,) = (line for line in shown(trace, tmp_path).splitlines() if "reaction" in line)
    assert reaction.split() == ["reaction", "0", "-", "-", "-"]
    (chain,) = json.loads(shown(trace, tmp_path, "--json"), parse_constant=pytest.fail)
    found = {part["part"]: part["p50_us"] for part in chain["parts"]}
    assert (found["total"], found["reaction"]) == (333, None)


def test_a_trace_without_messages_is_said_to_have_none(tmp_path: Path) -> None:
    assert shown(Trace("test", (), {}, 0), tmp_path) == "no message went through a chain\n"
