# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The texts that programs of this repository can print, taken from their sources."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from support import REPOSITORY

PYTHON = ("rmw_manycore_py", "bridge", "startup")
NATIVE = ("platform", "transport", "rmw", "ndt", "python")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
BETWEEN_PARTS = re.compile(r'"\s*\n\s*"')  # line breaks of a literal


def texts() -> Iterator[str]:
    """Yield every text in the sources; one with placeholders as the parts between them."""
    for folder in PYTHON:
        for file in (REPOSITORY / folder).rglob("*.py"):
            for node in ast.walk(ast.parse(file.read_text())):
                if isinstance(node, ast.Constant) and isinstance(node.value, str):
                    yield node.value
    for folder in NATIVE:
        for file in (REPOSITORY / "rmw_manycore" / folder).rglob("*.[ch]pp"):
            yield from LITERAL.findall(BETWEEN_PARTS.sub("", file.read_text()))
