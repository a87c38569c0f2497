# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Changes to modules of others after they are loaded."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from support import TIMEOUT_S

pytestmark = pytest.mark.unit

PROGRAM = """
from rmw_manycore_loading import ChangesAfterLoading

def append(text):
    return lambda name: [lambda module: module.told.append(text)] if name == "changed" else []

for purpose in ("one", "other", "one"):
    ChangesAfterLoading.install(purpose, append(purpose))
import changed
print(*changed.told)
"""


def test_hooks_of_several_purposes_change_one_module(tmp_path: Path) -> None:
    (tmp_path / "changed.py").write_text("told = ['loaded']")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        text=True,
        timeout=TIMEOUT_S,
        check=True,
    )
    assert done.stdout == "loaded one other\n"
