# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The library's C interface: complete, safe against null, and in agreement with Fast DDS."""

from __future__ import annotations

import ctypes
import re
import subprocess
import sys
from pathlib import Path

import pytest

from support import IS_MANYCORE, REPOSITORY

if not IS_MANYCORE:
    pytest.skip("is about the library itself", allow_module_level=True)

HEADERS = Path(sys.prefix, "include", "rmw", "rmw")
LIBRARIES = Path(sys.prefix, "lib")

ERROR, UNSUPPORTED, INVALID_ARGUMENT = 1, 3, 11

# Declared, but removed from ROS 2 long ago; no middleware defines them.
GONE = {"rmw_node_assert_liveliness"}
# Functions that return something other than a code or a handle.
OTHERS = {
    "rmw_event_type_is_supported",
    "rmw_feature_supported",
    "rmw_get_implementation_identifier",
    "rmw_get_serialization_format",
}
# Nothing may be passed to these either; they return UNSUPPORTED.
UNSUPPORTED_ANYWAY = {
    "rmw_fini_publisher_allocation",
    "rmw_fini_subscription_allocation",
    "rmw_get_serialized_message_size",
    "rmw_init_publisher_allocation",
    "rmw_init_subscription_allocation",
}
# Compiled only where rmw has them.
OF_LYRICAL = {"rmw_get_clients_info_by_service", "rmw_get_servers_info_by_service"}
# rmw.h requires the general error code for null.
PLAIN_ERROR = {"rmw_destroy_wait_set", "rmw_service_server_is_available", "rmw_set_log_severity"}
# These take structures by value: there are no null pointers to pass.
BY_VALUE = {"rmw_init_options_init", "rmw_qos_profile_check_compatible"}


def declared() -> set[str]:
    """Return the functions that rmw's headers declare and the rmw library does not define."""
    pattern = re.compile(r"^(rmw_\w+)\(", re.MULTILINE)
    names = {name for header in HEADERS.glob("*.h") for name in pattern.findall(header.read_text())}
    helper = ctypes.CDLL(str(LIBRARIES / "librmw.so"))
    return {name for name in names - GONE if not hasattr(helper, name)}


@pytest.fixture(scope="module")
def library() -> ctypes.CDLL:
    return ctypes.CDLL(str(LIBRARIES / "librmw_manycore.so"))


def test_every_function_is_there(library):
    names = declared()
    assert len(names) >= 95
    assert [name for name in sorted(names) if not hasattr(library, name)] == []


def test_the_conformance_page_counts_the_functions_and_names_the_unsupported_ones():
    page = (REPOSITORY / "docs/reference/conformance.md").read_text()
    pattern = r"Of the (\d+) functions .*?, (\d+) are\s+done.* and (\d+) answer"
    counts = re.search(pattern, page, re.DOTALL)
    assert counts
    done, unsupported = (named(part) for part in page.split("## Unsupported"))
    total = len(declared())
    assert tuple(map(int, counts.groups())) == (total, total - len(unsupported), len(unsupported))
    assert unsupported | done <= declared() | OF_LYRICAL
    assert unsupported >= UNSUPPORTED_ANYWAY


def named(text: str) -> set[str]:
    """Return the functions in the first columns of the tables."""
    rows = re.findall(r"^\| (`rmw_.*?) \|", text, re.MULTILINE)
    return {name for row in rows for name in re.findall(r"`(rmw_\w+)`", row)}


def returns_handle(name: str) -> bool:
    return "_create_" in name or name == "rmw_node_get_graph_guard_condition"


def answer_to_null(name: str) -> int | None:
    """Return what a function returns if all its arguments are null."""
    if returns_handle(name):
        return None
    if name in UNSUPPORTED_ANYWAY:
        return UNSUPPORTED
    return ERROR if name in PLAIN_ERROR else INVALID_ARGUMENT


def test_null_arguments_are_refused(library):
    errors = ctypes.CDLL(str(LIBRARIES / "librcutils.so"))
    errors.rcutils_error_is_set.restype = ctypes.c_bool
    nothing = [ctypes.c_void_p()] * 8
    wrong = []
    for name in sorted(declared() - OTHERS - BY_VALUE):
        errors.rcutils_reset_error()
        function = getattr(library, name)
        function.restype = ctypes.c_void_p if returns_handle(name) else ctypes.c_int
        result = function(*nothing)
        if result != answer_to_null(name) or not errors.rcutils_error_is_set():
            wrong.append((name, result))
    assert wrong == []


# Run without the stand-ins, so that the real Fast DDS can be loaded.
VERDICTS = """
import ctypes, itertools, sys
class Time(ctypes.Structure):
    _fields_ = [("sec", ctypes.c_uint64), ("nsec", ctypes.c_uint64)]
class Profile(ctypes.Structure):
    _fields_ = [
        ("history", ctypes.c_int), ("depth", ctypes.c_size_t), ("reliability", ctypes.c_int),
        ("durability", ctypes.c_int), ("deadline", Time), ("lifespan", Time),
        ("liveliness", ctypes.c_int), ("lease", Time), ("avoid", ctypes.c_bool),
    ]
check = ctypes.CDLL(sys.argv[1]).rmw_qos_profile_check_compatible
check.argtypes = [Profile, Profile, ctypes.POINTER(ctypes.c_int), ctypes.c_char_p, ctypes.c_size_t]
def verdict(*profiles):
    result, reason = ctypes.c_int(-1), ctypes.create_string_buffer(2048)
    code = check(*profiles, ctypes.byref(result), reason, 2048)
    return f"{code} {result.value} {bool(reason.value)}"
def profile(reliability=1, durability=2, liveliness=1, deadline=(0, 0), lease=(0, 0)):
    return Profile(1, 10, reliability, durability, Time(*deadline), Time(), liveliness,
                   Time(*lease), False)
kinds = list(itertools.product(range(5), range(5), range(6)))
for offered, requested in itertools.product(kinds, kinds):
    print(verdict(profile(*offered), profile(*requested)))
times = [(0, 0), (1, 0), (2, 0), (9223372036, 854775807)]
for a, b, c, d in itertools.product(times, repeat=4):
    print(verdict(profile(deadline=a, lease=b), profile(deadline=c, lease=d)))
"""


def verdicts(library: str) -> str:
    return subprocess.run(
        [sys.executable, "-S", "-E", "-c", VERDICTS, LIBRARIES / library],
        env={"LD_LIBRARY_PATH": library_path()},
        check=True,
        capture_output=True,
        text=True,
    ).stdout


def library_path() -> str:
    bundled = Path(sys.prefix).glob("lib/python*/site-packages/ros_*.libs")
    return ":".join(str(path) for path in [LIBRARIES, *bundled])


def test_profiles_are_compatible_as_with_fast_dds():
    ours = verdicts("librmw_manycore.so")
    assert ours.count("\n") > 20_000
    assert ours == verdicts("librmw_fastrtps_cpp.so")


def test_the_library_stays_when_it_is_unloaded() -> None:
    """Its threads may still be running."""
    script = (
        "import _ctypes, ctypes, sys; library = ctypes.CDLL(sys.argv[1]); "
        "_ctypes.dlclose(library._handle); "
        "print('librmw_manycore.so' in open('/proc/self/maps').read())"
    )
    command = [sys.executable, "-c", script, str(LIBRARIES / "librmw_manycore.so")]
    assert subprocess.check_output(command, text=True).strip() == "True"
