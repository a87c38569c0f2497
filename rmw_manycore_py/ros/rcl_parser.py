# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Binding of rcl_yaml_param_parser, the library that reads parameters for every ROS 2 node."""

from __future__ import annotations

import ctypes
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from rmw_manycore_py.errors import ManycoreError

_LIBRARIES = ("librcutils.so", "librcl_yaml_param_parser.so")
_C_PLACE = re.compile(r"\s*, at \S+:\d+$")


class RclError(Exception):
    """Error of rcl: its text without the place in rcl's sources."""


class _Allocator(ctypes.Structure):
    _fields_ = tuple((name, ctypes.c_void_p) for name in ("a", "d", "r", "z", "state"))


def _array_of(kind: type[Any]) -> type[ctypes.Structure]:
    fields = (("values", ctypes.POINTER(kind)), ("size", ctypes.c_size_t))
    return type("_Array", (ctypes.Structure,), {"_fields_": fields})


class _Strings(ctypes.Structure):
    _fields_ = (
        ("size", ctypes.c_size_t),
        ("data", ctypes.POINTER(ctypes.c_char_p)),
        ("allocator", _Allocator),
    )


class _Variant(ctypes.Structure):
    """Value of a parameter: rclcpp and rclpy take the first member that is not NULL."""

    _fields_ = (
        ("bool", ctypes.POINTER(ctypes.c_bool)),
        ("integer", ctypes.POINTER(ctypes.c_int64)),
        ("double", ctypes.POINTER(ctypes.c_double)),
        ("string", ctypes.c_char_p),
        ("bytes", ctypes.POINTER(_array_of(ctypes.c_uint8))),
        ("bools", ctypes.POINTER(_array_of(ctypes.c_bool))),
        ("integers", ctypes.POINTER(_array_of(ctypes.c_int64))),
        ("doubles", ctypes.POINTER(_array_of(ctypes.c_double))),
        ("strings", ctypes.POINTER(_Strings)),
    )

    @property
    def value(self) -> Any:
        """As a Python value; None if there is none, as for an empty list."""
        for scalar in (self.bool, self.integer, self.double):
            if scalar:
                return scalar[0]
        if self.string is not None:
            return self.string.decode()
        for array in (self.bytes, self.bools, self.integers, self.doubles):
            if array:
                return list(array[0].values[: array[0].size])
        if self.strings:
            return [text.decode() for text in self.strings[0].data[: self.strings[0].size]]
        return None


class _NodeParameters(ctypes.Structure):
    _fields_ = (
        ("names", ctypes.POINTER(ctypes.c_char_p)),
        ("values", ctypes.POINTER(_Variant)),
        ("size", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
    )


class _Parameters(ctypes.Structure):
    _fields_ = (
        ("node_names", ctypes.POINTER(ctypes.c_char_p)),
        ("nodes", ctypes.POINTER(_NodeParameters)),
        ("size", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", _Allocator),
    )


class _ErrorString(ctypes.Structure):
    _fields_ = (("text", ctypes.c_char * 1024),)


_Handle = ctypes.POINTER(_Parameters)


@cache
def _libraries() -> tuple[Any, Any]:
    """Load rcutils and the parser; both are found as a ROS 2 node finds them."""
    try:
        utilities, parser = map(ctypes.CDLL, _LIBRARIES)
    except OSError as error:
        raise ManycoreError(
            f"rcl's parser of parameters is not found ({error}): activate the environment that "
            "ROS 2 is installed in, or source its setup file"
        ) from error
    utilities.rcutils_get_default_allocator.restype = _Allocator
    utilities.rcutils_get_error_string.restype = _ErrorString
    text = ctypes.c_char_p
    parser.rcl_yaml_node_struct_init.restype = _Handle
    parser.rcl_yaml_node_struct_init.argtypes = (_Allocator,)
    parser.rcl_yaml_node_struct_fini.argtypes = (_Handle,)
    parser.rcl_parse_yaml_file.restype = ctypes.c_bool
    parser.rcl_parse_yaml_file.argtypes = (text, _Handle)
    parser.rcl_parse_yaml_value.restype = ctypes.c_bool
    parser.rcl_parse_yaml_value.argtypes = (text, text, text, _Handle)
    return utilities, parser


class Overrides:
    """Parameters from the files and values of one command line, in the order of the calls."""

    def __init__(self, handle: Any) -> None:
        self._handle = handle

    def add_file(self, path: str | os.PathLike[str]) -> None:
        """Read a file as `--params-file` does; raise RclError if rcl refuses it."""
        _check(_libraries()[1].rcl_parse_yaml_file(os.fsencode(path), self._handle))

    def add_value(self, section: str, name: str, text: str) -> None:
        """Read a value as `-p` does; raise RclError if rcl refuses it."""
        words = (section.encode(), name.encode(), text.encode())
        _check(_libraries()[1].rcl_parse_yaml_value(*words, self._handle))

    def sections(self) -> list[tuple[str, dict[str, Any]]]:
        """Return the values of each section, in the order in which their names first appeared."""
        all_of = self._handle[0]
        return [
            (all_of.node_names[index].decode(), _values(all_of.nodes[index]))
            for index in range(all_of.size)
        ]


@contextmanager
def overrides() -> Iterator[Overrides]:
    """Yield empty overrides, as of a command line without parameters."""
    utilities, parser = _libraries()
    handle = parser.rcl_yaml_node_struct_init(utilities.rcutils_get_default_allocator())
    if not handle:
        raise MemoryError
    try:
        yield Overrides(handle)
    finally:
        parser.rcl_yaml_node_struct_fini(handle)


def _values(node: _NodeParameters) -> dict[str, Any]:
    return {node.names[index].decode(): node.values[index].value for index in range(node.size)}


def _check(is_read: bool) -> None:
    if is_read:
        return
    utilities = _libraries()[0]
    text = utilities.rcutils_get_error_string().text.decode(errors="replace")
    utilities.rcutils_reset_error()
    raise RclError(_C_PLACE.sub("", text))
