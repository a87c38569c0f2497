# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Calls a function of a test file: peer.py FILE FUNCTION JSON-ARGUMENTS."""

import importlib.util
import json
import sys
from pathlib import Path
from types import ModuleType


def load(path: str) -> ModuleType:
    """Import a test file by its path."""
    spec = importlib.util.spec_from_file_location("peer_source", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def call(path: str, function: str, arguments: str) -> None:
    """Call a function of a test file."""
    del sys.argv[1:]
    getattr(load(path), function)(*json.loads(arguments))


if __name__ == "__main__":
    # Test files import `support`, not what is beside this file.
    sys.path[0] = str(Path(__file__).parents[2])
    call(*sys.argv[1:4])
