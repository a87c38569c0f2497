# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""An install prefix in which packages of Autoware have nodes of rmw_manycore as executables.

Nothing of their names is installed otherwise: only shells that source the prefix have them.
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
    """A package of Autoware, and the node in the place of one of its executables.

    :param parameters: of the node, where its names are not Autoware's by default.
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
OF_STOCK = ("launch", "config", "schema")  # folders of Autoware's packages that stay in use

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
    """Write the prefix; return the share directory of the Autoware that each package links to.

    None where no Autoware is sourced: then a package has no launch file. What an earlier call
    wrote of the packages is replaced.

    :raises OSError: when it cannot be written.
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
    """Keep the files of Autoware's package in use, and its other executables."""
    for name in OF_STOCK:
        if (stock / name).is_dir():
            (share / name).symlink_to(stock / name)
    programs = stock.parents[1] / "lib" / one.package
    for program in programs.iterdir() if programs.is_dir() else ():
        if program.name != one.executable:
            (library / program.name).symlink_to(program)


def _script(one: Replaced) -> str:
    """Return a script that runs the node; parameters of the command line come after its own."""
    words = shlex.join(own_program(one.module))
    if one.parameters:
        given = (f"-p {shlex.quote(parameter)}" for parameter in one.parameters)
        words += f" --ros-args {' '.join(given)} --"
    return f'#!/bin/sh\nexec {words} "$@"\n'


def _stock_share(prefix: Path, package: str) -> Path | None:
    """Return the share directory of Autoware's own package, whether or not the overlay is first."""
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
