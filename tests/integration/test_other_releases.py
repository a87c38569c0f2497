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


# What rmw has since Lyrical of the clients and servers of a service.
_SERVICE_ENDPOINTS = """
#pragma once
#include "rmw/rmw.h"
constexpr auto RMW_ENDPOINT_CLIENT = static_cast<rmw_endpoint_type_t>(3);
constexpr auto RMW_ENDPOINT_SERVER = static_cast<rmw_endpoint_type_t>(4);
struct rmw_service_endpoint_info_t;
struct rmw_service_endpoint_info_array_t {
  size_t size;
  rmw_service_endpoint_info_t * info_array;
};
extern "C" {
"""
_INFO, _ARRAY = "rmw_service_endpoint_info_t *", "rmw_service_endpoint_info_array_t *"
_ALLOCATOR, _TEXT = "rcutils_allocator_t *", "const char *"
_NODE = f"const rmw_node_t *, {_ALLOCATOR}, {_TEXT}, bool, {_ARRAY}"
_FUNCTIONS = {
    "get_clients_info_by_service": _NODE,
    "get_servers_info_by_service": _NODE,
    "service_endpoint_info_array_check_zero": _ARRAY,
    "service_endpoint_info_array_init_with_size": f"{_ARRAY}, size_t, {_ALLOCATOR}",
    "service_endpoint_info_array_fini": f"{_ARRAY}, {_ALLOCATOR}",
    "service_endpoint_info_set_node_name": f"{_INFO}, {_TEXT}, {_ALLOCATOR}",
    "service_endpoint_info_set_node_namespace": f"{_INFO}, {_TEXT}, {_ALLOCATOR}",
    "service_endpoint_info_set_service_type": f"{_INFO}, {_TEXT}, {_ALLOCATOR}",
    "service_endpoint_info_set_service_type_hash": f"{_INFO}, const rosidl_type_hash_t *",
    "service_endpoint_info_set_endpoint_type": f"{_INFO}, rmw_endpoint_type_t",
    "service_endpoint_info_set_endpoint_count": f"{_INFO}, size_t",
    "service_endpoint_info_set_gids": f"{_INFO}, const uint8_t *, size_t, size_t, {_ALLOCATOR}",
    "service_endpoint_info_set_qos_profiles": (
        f"{_INFO}, const rmw_qos_profile_t *, size_t, {_ALLOCATOR}"
    ),
}


def test_clients_and_servers_of_a_service_compile_where_rmw_has_them(tmp_path):
    declared = [f"rmw_ret_t rmw_{name}({types});" for name, types in _FUNCTIONS.items()]
    zero = "rmw_service_endpoint_info_array_t rmw_get_zero_initialized_{}(void);"
    array = zero.format("service_endpoint_info_array")
    rmw = tmp_path / "rmw"
    rmw.mkdir()
    text = "\n".join([_SERVICE_ENDPOINTS, *declared, array, "}", ""])
    (rmw / "get_service_endpoint_info.h").write_text(text)
    include = '#include "rmw/get_service_endpoint_info.h"\n'
    (rmw / "service_endpoint_info_array.h").write_text(include)
    source = REPOSITORY / "rmw_manycore/rmw/graph/service_endpoint_info.cpp"
    complete = tmp_path / "complete.cpp"  # arrays are written by index
    complete.write_text(f'{include}struct rmw_service_endpoint_info_t {{}};\n#include "{source}"\n')
    headers = [f"-I{path}" for path in (tmp_path, REPOSITORY / "rmw_manycore", INCLUDE)]
    headers += [f"-I{path}" for path in INCLUDE.iterdir()]
    options = ["-std=c++17", "-fsyntax-only", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["c++", *options, *headers, complete], check=True)
