# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many mutated mapfiles, launch files, parameter files and bridge files."""

from __future__ import annotations

import os
from pathlib import Path

from support.comparisons.mutated_files import read_mutated

FILES = int(os.environ.get("MANYCORE_TEST_MUTATED_FILES", "100000"))


def test_mutated_files_are_read_or_refused(tmp_path: Path) -> None:
    status, said = read_mutated(tmp_path, range(FILES))
    assert status == 0, said
