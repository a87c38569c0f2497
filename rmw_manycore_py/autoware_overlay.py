# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An install prefix in which `autoware_ndt_scan_matcher` is the node of rmw_manycore.

Nothing of that name is installed otherwise: only shells that source the prefix have it.
"""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

from rmw_manycore_program import own_program
from rmw_manycore_py.ros import ament

PACKAGE = "autoware_ndt_scan_matcher"
EXECUTABLE = "autoware_ndt_scan_matcher_node"
MODULE = "rmw_manycore_py.ndt.nodes.ndt_scan_matcher"
OF_STOCK = ("launch", "config", "schema")  # folders of Autoware's package that stay in use

PACKAGE_XML = f"""\
<?xml version="1.0"?>
<package format="3">
  <name>{PACKAGE}</name>
  <version>0.0.0</version>
  <description>The scan matcher of rmw_manycore in the place of Autoware's</description>
  <maintainer email="nobody@example.com">The rmw_manycore developers</maintainer>
  <license>Apache-2.0</license>
</package>
"""


def write_overlay(directory: Path) -> Path | None:
    """Write the prefix; return the share directory of the Autoware whose files it links to.

    None where no Autoware is sourced: then the package has no launch file. What an earlier call
    wrote is replaced.

    :raises OSError: when it cannot be written.
    """
    prefix = directory.resolve()
    stock = _stock_share(prefix)
    library, share = prefix / "lib" / PACKAGE, prefix / "share" / PACKAGE
    index = prefix / "share/ament_index/resource_index/packages"
    for folder in (library, share):
        shutil.rmtree(folder, ignore_errors=True)
    for folder in (library, share, index):
        folder.mkdir(parents=True, exist_ok=True)
    (index / PACKAGE).touch()
    (share / "package.xml").write_text(PACKAGE_XML)
    executable = library / EXECUTABLE
    executable.write_text(f'#!/bin/sh\nexec {shlex.join(own_program(MODULE))} "$@"\n')
    executable.chmod(0o755)
    for name in OF_STOCK:
        if stock is not None and (stock / name).is_dir():
            (share / name).symlink_to(stock / name)
    (prefix / "setup.sh").write_text(_setup(prefix))
    return stock


def _stock_share(prefix: Path) -> Path | None:
    """Return the share directory of Autoware's own package, whether or not the overlay is first."""
    for found in ament.prefixes():
        share = found / "share" / PACKAGE
        if found.resolve() != prefix and (share / "package.xml").is_file():
            return share.resolve()
    return None


def _setup(prefix: Path) -> str:
    path = shlex.quote(str(prefix))
    return (
        f"# Puts the {PACKAGE} of rmw_manycore before Autoware's.\n"
        f"AMENT_PREFIX_PATH={path}${{AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}}\n"
        "export AMENT_PREFIX_PATH\n"
    )
