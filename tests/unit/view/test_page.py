# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The files of the page agree."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path

PAGE = Path(str(files("rmw_manycore_py.view").joinpath("page")))


def imported(module: Path) -> set[Path]:
    """Return a module and all modules that it imports, directly or not."""
    found = {module}
    for name in re.findall(r'^import .* from "(.+)";$', module.read_text(), re.MULTILINE):
        found |= imported((module.parent / name).resolve())
    return found


def test_all_modules_are_loaded_at_once() -> None:
    html = (PAGE / "index.html").read_text()
    preloaded = re.findall(r'rel="modulepreload" href="page/(.+)"', html)
    main = PAGE.resolve() / "main.js"
    assert {PAGE.resolve() / name for name in preloaded} == imported(main) - {main}
