# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Launch files of one node read by us and by launch; of the first ones, its results are kept."""

from __future__ import annotations

import json
from pathlib import Path

from support.comparisons.comparing import DisagreementError, run
from support.comparisons.launch_values import FILE, by_launch, by_us, write
from support.generated.launch_files import made

KEPT = [json.loads(line) for line in FILE.read_text(encoding="utf-8").splitlines()]


def compare(directory: Path, number: int) -> str:
    file = write(directory, number, made(number))
    found, real = by_us(file), KEPT[number] if number < len(KEPT) else by_launch(file)
    if found != real:
        raise DisagreementError(f"{found}, launch {real}: {file.read_text()}")
    return "refused" if found is None else "read"


if __name__ == "__main__":
    run(compare)
