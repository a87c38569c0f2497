# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Libraries that only extras of the package install, and one error for all that are missing."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from importlib.util import find_spec
from types import ModuleType

from rmw_manycore_py.errors import ManycoreError


@dataclass(frozen=True)
class Library:
    """A library, what needs it, and the extra of pyproject.toml that installs it."""

    modules: tuple[str, ...]
    need: str
    extra: str
    or_else: str = ""


ICEORYX2 = Library(("iceoryx2",), "this comparison needs iceoryx2", "bench")
MATPLOTLIB = Library(("matplotlib.figure",), "plots need matplotlib", "bench")
MCAP = Library(("mcap.writer",), "recordings need mcap", "record")
OPEN3D = Library(
    ("open3d",),
    "downsampling needs Open3D",
    "ndt",
    "its system libraries: apt-get install libusb-1.0-0 libgl1 libegl1 libgomp1 libx11-6",
)
ORTOOLS = Library(("ortools.sat.python.cp_model",), "advice needs OR-tools", "advise")
PERFETTO = Library(
    ("perfetto.protos.perfetto.trace.perfetto_trace_pb2",),
    "Perfetto's format needs perfetto",
    "trace",
    "ui.perfetto.dev opens a .json as well",
)
LZF = Library(("lzf",), "compressed PCD files need python-neo-lzf", "ndt")
ROSBAGS = Library(("rosbags.highlevel", "rosbags.typesys"), "bags need rosbags", "ndt")
SIMPY = Library(("simpy",), "predictions need SimPy", "predict")
WEB_SERVER = Library(("aiohttp.web",), "the page needs aiohttp", "view", "--once draws without it")
ZENOH = Library(("zenoh", "xxhash"), "this bridge needs eclipse-zenoh and xxhash", "zenoh")


def require(library: Library) -> ModuleType:
    """Import a library and return its last module.

    Call it before a long run that needs the library at its end.

    :raises ManycoreError: with the command that installs it.
    """
    try:
        return [importlib.import_module(name) for name in library.modules][-1]
    except ImportError as error:
        raise ManycoreError(_text(library, error)) from error


def require_installed(library: Library) -> None:
    """Raise the error of `require`, but import nothing: for what another process imports."""
    if text := missing(library):
        raise ManycoreError(text)


def missing(library: Library) -> str:
    """Return the text of that error, or nothing if the library is installed."""
    tops = (name.partition(".")[0] for name in library.modules)
    absent = next((name for name in tops if find_spec(name) is None), None)
    return _text(library, f"No module named {absent!r}") if absent else ""


def _text(library: Library, cause: object) -> str:
    text = f"{library.need} ({cause}): pip install 'rmw-manycore[{library.extra}]'"
    return f"{text}; {library.or_else}" if library.or_else else text
