# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The numbered examples of the Python API, each run as its docstring says.

test_installed.py runs some of them from the wheel.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

import rmw_manycore_py as manycore
from support import REPOSITORY, TIMEOUT_S

pytestmark = pytest.mark.integration

EXAMPLES = REPOSITORY / "examples"


def command(name: str, *arguments: str) -> list[str]:
    """Return the command that runs an example."""
    return [sys.executable, str(EXAMPLES / f"{name}.py"), *arguments]


def test_a_mapfile_is_checked(start, tmp_path: Path) -> None:
    shown = start(command("01_check_a_mapfile"))
    assert shown.wait() == 0, shown
    assert "/talker: cluster 1 core 1, host CPU " in shown.output
    assert "/chatter: clusters (1,) to (2,)" in shown.lines
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text("nodes:\n  talker: {cluster: 0, package: rmw_manycore, executable: talker}\n")
    refused = start(command("01_check_a_mapfile", str(wrong)))
    assert refused.wait() == 2, refused
    assert re.search(r"wrong\.yaml:2 .*cluster: expected ", refused.output), refused


def test_a_mapfile_is_run(start, platform: str) -> None:
    shown = start(command("02_run_a_mapfile"))
    assert shown.wait(2 * TIMEOUT_S) == 0, shown
    assert re.search(r"^talker is running: pid \d+, cluster 1$", shown.output, re.MULTILINE)
    assert re.search(r"^listener \| .*I heard", shown.output, re.MULTILINE), shown
    assert re.search(r"^cluster 2: \d+ of \d+ bytes used$", shown.output, re.MULTILINE), shown
    assert re.search(r"^/talker: publisher, [1-9]\d* messages$", shown.output, re.MULTILINE), shown
    assert platform not in manycore.platforms()


def test_arrays_are_published_and_taken(start) -> None:
    publisher = start(command("03_publish_arrays", "5"))
    taker = start(command("04_take_arrays"))
    for number in range(1, 5):
        taker.wait_for(rf"^cloud {number}: \(1000, 3\), centre \[{number}\.\d* ")
    assert taker.wait() == 0, taker
    assert publisher.wait() == 0, publisher
    assert "0 clouds were overwritten before they were taken" in taker.lines
    assert "published 5 clouds in cluster 1" in publisher.output


def test_a_scan_is_aligned(start) -> None:
    shown = start(command("05_align_a_scan"))
    assert shown.wait() == 0, shown
    assert "converged: True" in shown.lines
    (error_cm,) = re.findall(r"^([\d.]+) cm from", shown.output, re.MULTILINE)
    assert float(error_cm) < 5.0


def test_a_pipeline_loses_no_image(start, platform: str) -> None:
    shown = start(command("06_pipeline"))
    assert shown.wait(2 * TIMEOUT_S) == 0, shown
    lines = [line for line in shown.lines if line.startswith("display | image ")]
    assert lines == [
        f"display | image {n}: rows {10 * n - 10} to {10 * n + 89}, columns [199 299]"
        for n in range(1, 31)
    ]
    assert platform not in manycore.platforms()


def test_transfers_reach_the_other_process(start) -> None:
    shown = start(command("07_transfers"))
    assert shown.wait() == 0, shown
    assert shown.lines == [
        *(f"image: (480, 640), mean {number}.0" for number in (1, 2, 3)),
        "command of priority 7: stop",
        "command of priority 0: slow down",
        "map: 1000000 points, the last one 999999.0",
    ]


def test_every_example_is_run_here() -> None:
    used = set(re.findall(r'command\("(\w+)"', Path(__file__).read_text()))
    assert used == {path.stem for path in EXAMPLES.glob("*.py")}
