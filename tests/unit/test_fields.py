# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Fast fields of messages, compared with the generated classes alone."""

from __future__ import annotations

import array
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rmw_manycore_fields as fields
from support import TESTS, TIMEOUT_S

pytestmark = pytest.mark.unit

IS_FAST = "'_rmw_manycore_fields.Array' in str(type(m.array.array))"
SHOW = f"import sensor_msgs.msg._image as m; print({IS_FAST})"


def run(*arguments: str, **variables: str) -> str:
    names = ("RMW_IMPLEMENTATION", fields.VARIABLE)
    environment = {name: value for name, value in os.environ.items() if name not in names}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=TESTS,
        env={**environment, **variables},
        stdout=subprocess.PIPE,
        text=True,
        timeout=TIMEOUT_S,
        check=True,
    )
    return done.stdout


@pytest.mark.parametrize("options", [(), ("-O",)])
def test_every_field_takes_every_value_as_generated(options: tuple[str, ...]) -> None:
    report = json.loads(run(*options, "-m", "support.comparisons.fields"))
    assert report["differences"] == []
    assert report["fast_fields"] > 100
    assert report["comparisons"] > 40_000


@pytest.mark.parametrize(
    ("typecode", "values"),
    [
        ("B", np.ones(64, np.uint8)),
        ("B", np.ones(128, np.int64)[::2]),
        ("B", memoryview(bytes(64))),
        ("q", np.ones(64, np.int64)),
        ("f", np.ones(64, np.float64)),
        ("f", np.ones(64, ">f4")),
        ("f", array.array("d", [1] * 64)),
        ("d", np.ones(64, np.int32)),
    ],
)
def test_values_that_are_copied_at_once(typecode: str, values: object) -> None:
    found = fields.convert(typecode, values)
    assert found == array.array(typecode, values)  # type: ignore[call-overload]
    assert found.typecode == typecode


@pytest.mark.parametrize(
    "values",
    [np.full(64, 256), np.ones(64), np.ones((8, 8), np.uint8), np.ones(64, bool), [1] * 64],
)
def test_other_values_are_left_to_python(values: object) -> None:
    assert fields.convert("B", values) is None


def test_a_field_does_not_share_memory_with_its_value() -> None:
    values = np.ones(64, np.uint8)
    found = fields.convert("B", values)
    values[0] = 2
    assert found[0] == 1


@pytest.mark.parametrize(
    ("variables", "is_fast"),
    [
        ({"RMW_IMPLEMENTATION": "rmw_manycore"}, True),
        ({"RMW_IMPLEMENTATION": "rmw_manycore", fields.VARIABLE: "0"}, False),
        ({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, False),
        ({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp", fields.VARIABLE: "1"}, True),
    ],
)
def test_programs_with_fast_fields(variables: dict[str, str], is_fast: bool) -> None:
    assert run("-c", SHOW, **variables) == f"{is_fast}\n"


def test_messages_imported_before_are_changed_too() -> None:
    imports = "import sensor_msgs.msg._image as m, rmw_manycore_fields"
    assert run("-c", f"{imports}; rmw_manycore_fields.install(); print({IS_FAST})") == "True\n"


def test_modules_that_are_not_generated_stay(tmp_path: Path) -> None:
    package = tmp_path / "other/msg"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("from . import _own")
    (package / "_own.py").write_text("import array")
    code = "import array, other.msg._own as own; print(own.array is array)"
    assert run("-c", code, PYTHONPATH=str(tmp_path), **{fields.VARIABLE: "1"}) == "True\n"


def test_without_the_compiled_module_messages_stay_as_generated() -> None:
    missing = "import sys; sys.modules['_rmw_manycore_fields'] = None"
    assert run("-c", f"{missing}; {SHOW}", **{fields.VARIABLE: "1"}) == "False\n"


def test_messages_are_copied_pickled_and_compared_as_generated() -> None:
    code = (
        "import array, copy, pickle, numpy as np; from sensor_msgs.msg import Image\n"
        "one = Image(data=np.arange(64, dtype=np.uint8))\n"
        "class Own(Image): pass\n"
        "own = Own(); own.data = memoryview(one.data)\n"
        "same = [copy.deepcopy(one), pickle.loads(pickle.dumps(one))]\n"
        "print(all(m == one and type(m.data) is array.array for m in same), own.data == one.data)"
    )
    assert run("-c", code, **{fields.VARIABLE: "1"}) == "True True\n"
