# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Many mutated mapfiles, launch files, parameter files and bridge files."""

from __future__ import annotations

from pathlib import Path

from mutated_files import read_mutated


def test_a_hundred_thousand_mutated_files_are_read_or_refused(tmp_path: Path) -> None:
    status, said = read_mutated(tmp_path, range(100_000))
    assert status == 0, said
