# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Scripts that draw the page start a viewer, or end."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from support import TIMEOUT_S
from support.processes.commands import manycore_command

pytestmark = pytest.mark.unit

SCRIPT = Path(__file__).parents[2] / "scripts/start_view.sh"
SHOW = f". {SCRIPT}; start_view; echo $link; kill $view; wait $view || true"


def start_view(directory: Path, platform: str) -> subprocess.CompletedProcess[str]:
    (directory / "build").mkdir()
    path = f"{Path(manycore_command()[0]).parent}:{os.environ['PATH']}"
    return subprocess.run(
        ["sh", "-euc", SHOW],
        cwd=directory,
        env={**os.environ, "PATH": path, "MANYCORE_PLATFORM": platform},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )


@pytest.mark.needs("aiohttp")
def test_a_viewer_is_started(tmp_path: Path, platform: str) -> None:
    done = start_view(tmp_path, platform)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("http://127.0.0.1:")


def test_a_viewer_that_ends_is_told_with_its_reason(tmp_path: Path) -> None:
    done = start_view(tmp_path, "no/name")
    assert done.returncode == 1
    assert done.stderr.startswith("manycore view does not start: manycore: MANYCORE_PLATFORM: ")
    assert "found 'no/name'" in done.stderr
