# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`pip install .`, which builds apart from what is installed, finds all that the build uses."""

from __future__ import annotations

import os
import re
import sys
from importlib.metadata import distribution, distributions
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

pytestmark = pytest.mark.unit

REPOSITORY = Path(__file__).parents[2]
PREFIX = Path(sys.prefix)
NINJA = REPOSITORY / "build/install/build.ninja"  # of this checkout's set-up
USED = re.compile(rf"{re.escape(str(PREFIX))}/(include/\w+|lib/lib[\w.+-]+\.so)")


def installed_for_a_build() -> set[str]:
    """Return the names of the build requirements, and of what they require."""
    text = (REPOSITORY / "pyproject.toml").read_text()
    requires = text.partition("requires = [")[2].partition("\n]")[0]
    left = [Requirement(line) for line in re.findall(r'^  "([^"]+)"', requires, re.MULTILINE)]
    assert left
    found: set[str] = set()
    while left:
        requirement = left.pop()
        name = canonicalize_name(requirement.name)
        is_needed = requirement.marker is None or requirement.marker.evaluate({"extra": ""})
        if is_needed and name not in found:
            found.add(name)
            left += [Requirement(line) for line in distribution(name).requires or ()]
    return found


def owners() -> dict[str, set[str]]:
    """Return the distributions of ROS that own each library and each folder of headers."""
    found: dict[str, set[str]] = {}
    for owner in distributions():
        name = canonicalize_name(owner.name)
        for file in owner.files or () if name.startswith("ros-") else ():
            path = Path(os.path.normpath(owner.locate_file(file)))
            if path.is_relative_to(PREFIX):
                part = "/".join(path.relative_to(PREFIX).parts[:2])
                found.setdefault(part, set()).add(name)
    return found


def test_what_the_build_uses_is_required() -> None:
    used = set(USED.findall(NINJA.read_text()))
    assert {"include/rmw", "lib/librcl.so"} <= used
    owned, required = owners(), installed_for_a_build()
    assert {part: owned[part] for part in used if not owned[part] & required} == {}
