# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Forks of a process that has imported rclpy and initialised none of it."""

from __future__ import annotations

import ctypes
import functools
import gc
import importlib
import os
import re
import sys
import warnings
from pathlib import Path

from rclpy.type_support import check_for_type_support

from support.processes.platforms import leftovers

# What a node and most tests use, and what rclpy imports only for the first node.
MODULES = (
    *("numpy", "support.nodes.payload", "rclpy.action", "support.nodes.ros", "rosidl_generator_py"),
    *("rmw_manycore_py.cli.main", "rmw_manycore_py.cli.run", "rich.console", "rich.table", "yaml"),
    *("rmw_manycore_py.cli.topic.echo", "rmw_manycore_py.ndt.nodes.ndt_scan_matcher"),
    *("rmw_manycore_bridge.process", "rmw_manycore_bridge.fastdds.outside"),
    "rmw_manycore_py.view.server",
)
MESSAGES = (
    "rcl_interfaces.msg",
    "rcl_interfaces.srv",
    "rosgraph_msgs.msg",
    "std_msgs.msg",
    "type_description_interfaces.srv",
)
SIGSET_BYTES = 128


def preload() -> None:
    """Import what each child would otherwise import itself.

    The objects are frozen: a garbage collection in a child, as pytest runs after each test and
    Python at exit, would write to all of them and copy each page.
    """
    for name in MODULES:
        importlib.import_module(name)
    for name in MESSAGES:
        for message in vars(importlib.import_module(name)).values():
            if isinstance(message, type):
                check_for_type_support(message)
    gc.collect()
    gc.freeze()


def fork() -> int:
    """Fork a child that may join a platform, while this process has joined none; return 0 in it."""
    assert not leftovers(os.environ["MANYCORE_PLATFORM"]), "the process to fork is on a platform"
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    signals = ctypes.create_string_buffer(SIGSET_BYTES)
    _tell_tracing("before_fork", signals)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of a fork beside other threads
        pid = os.fork()
    _tell_tracing("after_fork_parent" if pid else "after_fork_child", signals)
    return pid


def _tell_tracing(event: str, signals: ctypes.Array[ctypes.c_char]) -> None:
    """Notify the tracing library of ROS 2 of a fork.

    Its threads do not exist in the child, where it has to start new ones; at exit it cancels the
    threads that it still has on record.
    """
    if (library := _tracing_library()) is not None:
        prefix = "" if hasattr(library, "ust_before_fork") else "lttng_"
        getattr(library, f"{prefix}ust_{event}")(signals)


@functools.cache
def _tracing_library() -> ctypes.CDLL | None:
    found = re.search(r"/\S*/liblttng-ust(-[0-9a-f]+)?\.so\S*", Path("/proc/self/maps").read_text())
    return ctypes.CDLL(found[0]) if found else None
