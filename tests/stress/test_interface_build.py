# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Large packages: those of the wheels built from their definitions, and one of many actions."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE
from support.installs.building import interface

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore")

SHARE = Path(sys.prefix) / "share"
KINDS = ("msg", "srv", "action")
COPIES = 20


@pytest.mark.parametrize("package", ["std_msgs", "geometry_msgs", "sensor_msgs", "test_msgs"])
def test_each_type_has_the_hash_of_the_wheel(package: str, tmp_path: Path) -> None:
    env = {**os.environ, "MANYCORE_INTERFACES": str(tmp_path / "built")}
    interface("build", SHARE / package, env=env)
    (built,) = tmp_path.glob(f"built/*/current/share/{package}")
    files = [file for kind in KINDS for file in sorted((SHARE / package).glob(f"{kind}/*.json"))]
    assert files
    for file in files:
        again = built / file.relative_to(SHARE / package)
        assert json.loads(again.read_text()) == json.loads(file.read_text()), file


def test_a_package_of_many_actions_is_built_and_imported(tmp_path: Path) -> None:
    """As many definitions as in nav2_msgs, with as many actions among them."""
    env = {**os.environ, "MANYCORE_INTERFACES": str(tmp_path / "built")}
    package = tmp_path / "many_msgs"
    for kind, name in (("action", "Fibonacci"), ("srv", "Arrays"), ("msg", "BasicTypes")):
        (package / kind).mkdir(parents=True)
        for number in range(COPIES if kind != "srv" else COPIES // 2):
            source = SHARE / "test_msgs" / kind / f"{name}.{kind}"
            copy = package / kind / f"{name}{number}.{kind}"
            # Types of test_msgs itself are used without a package name.
            copy.write_text(re.sub(r"(?m)^(?=[A-Z]\w*[ \[])", "test_msgs/", source.read_text()))
    done = interface("build", package, env=env)
    print(done.stdout)
    code = "from many_msgs import action, msg, srv; print(action.Fibonacci7.Goal())"
    subprocess.run([sys.executable, "-c", code], env=env, check=True)
