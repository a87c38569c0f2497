# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Versions of rmw_manycore and what it runs on."""

from __future__ import annotations

import os
import platform
import sys
from importlib import metadata
from typing import Any

from rmw_manycore_py import __version__

_OTHERS = ("click", "nanobind", "numpy", "pydantic", "PyYAML")


def versions(*, packages: bool = True) -> dict[str, Any]:
    """Return the versions of rmw_manycore, Python and, if wanted, libraries and ROS 2 wheels."""
    return {**_own(), **(_of_packages() if packages else {})}


def _own() -> dict[str, Any]:
    return {
        "rmw_manycore": __version__,
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "python prefix": sys.prefix,
        "glibc": os.confstr("CS_GNU_LIBC_VERSION"),
        "ROS_DISTRO": os.environ.get("ROS_DISTRO", "not set"),
    }


def _of_packages() -> dict[str, Any]:
    installed = {name: dist.version for dist in metadata.distributions() if (name := dist.name)}
    wheels = {name: installed[name] for name in sorted(installed) if name.startswith("ros-")}
    return {
        "packages": {name: installed.get(name, "not installed") for name in _OTHERS},
        "ROS 2 wheels": wheels or "none installed",
    }
