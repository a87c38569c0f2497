# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The library beside the ROS 2 of another distribution than the one it was built for."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import rmw_manycore_distribution
from support import IS_MANYCORE

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="is about the library itself"),
]

MISMATCH_STATUS = 102  # as that of rcl
PREFIX = Path(sys.prefix)
# What the library needs of Fast CDR; every distribution defines these. With a name that only its
# own distribution defines, the loader would end a program before the library can say why.
FAST_CDR = {
    "Cdr::Cdr(eprosima::fastcdr::FastBuffer&, eprosima::fastcdr::Cdr::Endianness, "
    "eprosima::fastcdr::CdrVersion)",
    "Cdr::DEFAULT_ENDIAN",
    "Cdr::deserialize(char&)",
    "Cdr::get_serialized_data_length() const",
    "Cdr::read_encapsulation()",
    "Cdr::serialize(char)",
    "Cdr::serialize_encapsulation()",
    "Cdr::set_encoding_flag(eprosima::fastcdr::EncodingAlgorithmFlag)",
    "Cdr::state::state(eprosima::fastcdr::Cdr const&)",
    "FastBuffer::FastBuffer(char*, unsigned long)",
    "FastBuffer::~FastBuffer()",
    "exception::Exception",
}
LOAD = "import ctypes, sys; ctypes.CDLL(sys.argv[1]); print('loaded')"


def load_beside(rmw_version: str, prefix: Path) -> subprocess.CompletedProcess[str]:
    """Load the library in a process that finds the rmw of a prefix first."""
    (prefix / "lib").mkdir(parents=True)
    (prefix / "share/rmw").mkdir(parents=True)
    shutil.copy(PREFIX / "lib/librmw.so", prefix / "lib")
    package = f"<package>\n  <name>rmw</name>\n  <version>{rmw_version}</version>\n</package>\n"
    (prefix / "share/rmw/package.xml").write_text(package)
    return subprocess.run(
        [sys.executable, "-I", "-S", "-c", LOAD, PREFIX / "lib/librmw_manycore.so"],
        env={"LD_LIBRARY_PATH": f"{prefix}/lib{os.pathsep}{PREFIX}/lib"},
        capture_output=True,
        text=True,
        check=False,
    )


def test_another_distribution_is_refused_in_one_line(tmp_path: Path) -> None:
    result = load_beside("99.8.2", tmp_path)
    own = f"{rmw_manycore_distribution.NAME} (rmw {rmw_manycore_distribution.RMW_VERSION})"
    (line,) = result.stderr.splitlines()
    assert line.startswith(
        f"rmw_manycore: built for ROS 2 {own}, but {tmp_path} has rmw 99.8.2; install "
    )
    assert (result.returncode, result.stdout) == (MISMATCH_STATUS, "")


def test_another_release_of_the_distribution_is_accepted(tmp_path: Path) -> None:
    result = load_beside(f"{rmw_manycore_distribution.RMW_VERSION}.99", tmp_path)
    assert (result.returncode, result.stdout, result.stderr) == (0, "loaded\n", "")


def test_nothing_is_needed_of_one_distribution_alone() -> None:
    listed = subprocess.run(
        ["nm", "-DC", "--undefined-only", PREFIX / "lib/librmw_manycore.so"],
        capture_output=True,
        text=True,
        check=True,
    )
    needed = set(re.findall(r" U .*?eprosima::fastcdr::(.*)", listed.stdout))
    assert needed - FAST_CDR == set()


def test_the_rmw_of_this_environment_is_the_distributions() -> None:
    package = (PREFIX / "share/rmw/package.xml").read_text()
    assert f"<version>{rmw_manycore_distribution.RMW_VERSION}." in package
