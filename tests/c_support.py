# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The C libraries under rclpy, and the handles in them of rclpy's entities."""

from __future__ import annotations

import ctypes
import sys
from pathlib import Path
from typing import Any

from support import RMW

LIBRARIES = Path(sys.prefix, "lib")

rmw = ctypes.CDLL(str(LIBRARIES / f"lib{RMW}.so"))
rcl = ctypes.CDLL(str(LIBRARIES / "librcl.so"))
rcutils = ctypes.CDLL(str(LIBRARIES / "librcutils.so"))


def rcl_handle(entity: Any) -> ctypes.c_void_p:
    return ctypes.c_void_p(entity.handle.pointer)


def rmw_handle(kind: str, entity: Any) -> ctypes.c_void_p:
    """Return the rmw handle of an entity; `kind` as in "rcl_publisher_get_rmw_handle"."""
    function = getattr(rcl, f"rcl_{kind}_get_rmw_handle")
    function.restype = ctypes.c_void_p
    return ctypes.c_void_p(function(rcl_handle(entity)))


def type_support(message_type: Any) -> ctypes.c_void_p:
    get_pointer = ctypes.pythonapi.PyCapsule_GetPointer
    get_pointer.restype = ctypes.c_void_p
    get_pointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    if message_type.__class__._TYPE_SUPPORT is None:
        message_type.__class__.__import_type_support__()
    return ctypes.c_void_p(get_pointer(message_type.__class__._TYPE_SUPPORT, None))
