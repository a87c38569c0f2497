# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parts of the library, compiled against headers as other releases of ROS 2 have them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE, REPOSITORY, TESTS

if not IS_MANYCORE:
    pytest.skip("is about the library itself", allow_module_level=True)

pytestmark = pytest.mark.integration

PREFIX = Path(sys.prefix)
INCLUDE = PREFIX / "include"
SERIALIZATION = REPOSITORY / "rmw_manycore/rmw/serialization"
EVENTS = INCLUDE / "rmw/rmw/event.h"
EXCEPTION = INCLUDE / "fastcdr/exceptions/Exception.h"


def compile_and_run(directory: Path, header: Path, source: str, *options: str | Path) -> int:
    """Return the status of a program that includes the header before all others."""
    program = directory / "program"
    headers = [f"-I{path}" for path in (REPOSITORY / "rmw_manycore", INCLUDE, *INCLUDE.iterdir())]
    command = ["c++", "-std=c++17", "-Wall", "-Werror", "-include", header, *headers]
    command += [TESTS / "programs" / source, "-o", program, f"-L{PREFIX}/lib", *options]
    subprocess.run(command, check=True)
    env = {"LD_LIBRARY_PATH": str(PREFIX / "lib")}
    return subprocess.run([program], env=env, check=False).returncode


def changed(directory: Path, header: Path, *changes: tuple[str, str]) -> Path:
    text = header.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    copy = directory / header.name
    copy.write_text(text)
    return copy


@pytest.mark.parametrize("invalid", ["last", "first"])
def test_all_events_are_supported(tmp_path, invalid):
    """Some releases begin with RMW_EVENT_INVALID, and end with RMW_EVENT_TYPE_MAX."""
    first = "  RMW_EVENT_LIVELINESS_CHANGED"
    changes = [
        ("  RMW_EVENT_INVALID\n", "  RMW_EVENT_TYPE_MAX\n"),
        (first, f"  RMW_EVENT_INVALID,\n{first}"),
    ]
    header = changed(tmp_path, EVENTS, *(changes if invalid == "first" else []))
    options = ("-ffunction-sections", "-Wl,--gc-sections")  # without the functions on endpoints
    assert compile_and_run(tmp_path, header, "event_types.cpp", *options) == 0


@pytest.mark.parametrize("base", ["std::exception", "none"])
def test_exceptions_of_fast_cdr_are_translated(tmp_path, base):
    """Those of Fast CDR 2.3 do not derive from std::exception."""
    changes = [('"../fastcdr_dll.h"', '"fastcdr/fastcdr_dll.h"')]
    if base == "none":
        changes += [
            (" : public std::exception", ""),
            ("what() const noexcept override", "what() const noexcept"),
        ]
    header = changed(tmp_path, EXCEPTION, *changes)
    names = ("cdr_lengths.cpp", "cut_cdr.cpp", "length_plan.cpp")
    sources = [SERIALIZATION / name for name in names]
    libraries = ["-lfastcdr", "-lrosidl_runtime_c", "-lrcutils"]
    options = (*sources, *libraries, "-Wl,--allow-shlib-undefined")
    assert compile_and_run(tmp_path, header, "fast_cdr_exception.cpp", *options) == 0
