# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Install prefix whose Autoware packages run nodes of rmw_manycore.

Packages of these names exist only in shells that source the prefix.
"""

from __future__ import annotations

import shlex
import shutil
from dataclasses import dataclass
from pathlib import Path

from rmw_manycore_program import own_program
from rmw_manycore_py.ros import ament


@dataclass(frozen=True)
class Replaced:
    """A package of Autoware, and the node that replaces one of its executables.

    :param parameters: parameters of the node whose default names differ from Autoware's.
    """

    package: str
    executable: str
    module: str
    parameters: tuple[str, ...] = ()


MATCHER = Replaced(
    "autoware_ndt_scan_matcher",
    "autoware_ndt_scan_matcher_node",
    "rmw_manycore_py.ndt.nodes.ndt_scan_matcher",
)
MAP_LOADER = Replaced(
    "autoware_map_loader",
    "autoware_pointcloud_map_loader",
    "rmw_manycore_py.ndt.nodes.pointcloud_map_loader",
    ("map_topic:=output/pointcloud_map",),
)
OF_STOCK = ("launch", "config", "schema")  # directories linked from Autoware's packages

PACKAGE_XML = """\
<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>0.0.0</version>
  <description>A node of rmw_manycore in the place of Autoware's</description>
  <maintainer email="nobody@example.com">The rmw_manycore developers</maintainer>
  <license>Apache-2.0</license>
</package>
"""


def write_overlay(directory: Path, packages: tuple[Replaced, ...]) -> dict[str, Path | None]:
    """Write the prefix; return the stock share directory that each package links to.

    None if no Autoware is sourced: that package then has no launch file. Replaces the packages
    written by an earlier call.

    :raises OSError: if it cannot be written.
    """
    prefix = directory.resolve()
    found = {one.package: _write_package(prefix, one) for one in packages}
    (prefix / "setup.sh").write_text(_setup(prefix))
    return found


def _write_package(prefix: Path, one: Replaced) -> Path | None:
    stock = _stock_share(prefix, one.package)
    library, share = prefix / "lib" / one.package, prefix / "share" / one.package
    index = prefix / "share/ament_index/resource_index/packages"
    for folder in (library, share):
        shutil.rmtree(folder, ignore_errors=True)
    for folder in (library, share, index):
        folder.mkdir(parents=True, exist_ok=True)
    (index / one.package).touch()
    (share / "package.xml").write_text(PACKAGE_XML.format(package=one.package))
    if stock is not None:
        _link_stock(stock, library, share, one)
    executable = library / one.executable
    executable.write_text(_script(one))
    executable.chmod(0o755)
    return stock


def _link_stock(stock: Path, library: Path, share: Path, one: Replaced) -> None:
    """Link the files of Autoware's package and its other executables."""
    for name in OF_STOCK:
        if (stock / name).is_dir():
            (share / name).symlink_to(stock / name)
    programs = stock.parents[1] / "lib" / one.package
    for program in programs.iterdir() if programs.is_dir() else ():
        if program.name != one.executable:
            (library / program.name).symlink_to(program)


def _script(one: Replaced) -> str:
    """Return a script that runs the node; command-line parameters come after its own."""
    words = shlex.join(own_program(one.module))
    if one.parameters:
        given = (f"-p {shlex.quote(parameter)}" for parameter in one.parameters)
        words += f" --ros-args {' '.join(given)} --"
    return f'#!/bin/sh\nexec {words} "$@"\n'


def _stock_share(prefix: Path, package: str) -> Path | None:
    """Return the share directory of Autoware's own package, even if the overlay comes first."""
    for found in ament.prefixes():
        share = found / "share" / package
        if found.resolve() != prefix and (share / "package.xml").is_file():
            return share.resolve()
    return None


def _setup(prefix: Path) -> str:
    path = shlex.quote(str(prefix))
    return (
        "# Puts nodes of rmw_manycore before Autoware's.\n"
        f"AMENT_PREFIX_PATH={path}${{AMENT_PREFIX_PATH:+:$AMENT_PREFIX_PATH}}\n"
        "export AMENT_PREFIX_PATH\n"
    )
