# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Libraries for LD_PRELOAD, from the sources in tests/programs."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from support import TESTS


def preloaded(name: str, directory: Path) -> dict[str, str]:
    """Compile NAME.c to a library in a directory; return the variables that preload it."""
    library = directory / f"{name}.so"
    source = TESTS / "programs" / f"{name}.c"
    compiler = os.environ.get("CC", "cc")
    subprocess.run([compiler, "-shared", "-fPIC", "-o", library, source], check=True)
    return {"LD_PRELOAD": str(library)}
