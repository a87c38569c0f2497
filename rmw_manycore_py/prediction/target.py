# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a platform adds to an application: CPUs, and what a message costs there.

Each parameter has the source of its value. docs/design/prediction.md explains them.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Any, Literal, get_args

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError

Source = Literal["published", "measured here", "fitted", "unknown", "chosen"]
Cpus = Literal["host", "cores", "shared", "own"]
Network = Literal["memory", "bus", "bostan"]
SOURCES: tuple[str, ...] = get_args(Source)


def _parameter(default: float, text: str) -> Any:
    return field(default=default, metadata={"text": text})


@dataclass(frozen=True)
class Target:
    """A platform's parameters; times are CPU times unless they say otherwise.

    :ivar cpus: `host`: cores share host CPUs as placed; `cores`: each core is a CPU of its own;
        `shared`: any thread runs on any of `cpu_count` CPUs; `own`: each thread has a CPU.
    :ivar network: what a message passes between clusters.
    :ivar sources: where the value of each parameter comes from.
    """

    name: str
    cpus: Cpus
    network: Network
    sources: dict[str, Source]
    cpu_count: float = _parameter(2, "CPUs that all threads share")
    speed: float = _parameter(1.0, "speed of a CPU / of one of the profile's machine")
    wake_us: float = _parameter(0.0, "from waking a thread until it runs, on an idle CPU")
    wake_busy_us: float = _parameter(0.0, "likewise, on a CPU that is busy")
    dispatch_us: float = _parameter(0.0, "from there to a callback, where the profile lacks it")
    publish_us: float = _parameter(0.0, "of a publish before readers see it, where it lacks it")
    receive_us: float = _parameter(0.0, "of a receive thread per eMCOS message")
    switch_us: float = _parameter(0.0, "of a change of threads")
    slice_us: float = _parameter(3000.0, "for which a thread keeps a CPU that others want")
    message_us: float = _parameter(0.0, "of an eMCOS message between clusters")
    bytes_per_us: float = _parameter(1e6, "of a link between clusters")

    def ns(self, name: str) -> float:
        """Return a time in ns."""
        value: float = getattr(self, name)
        return value * 1e3

    @property
    def unknown(self) -> tuple[str, ...]:
        """Names of the parameters whose values are not known."""
        return tuple(name for name, source in self.sources.items() if source == "unknown")

    def changed(self, values: dict[str, float], source: Source) -> Target:
        """Return the target with other values of some parameters.

        :raises ManycoreError: for a parameter that does not exist, or is out of range.
        """
        for name, value in values.items():
            if name not in PARAMETERS:
                known = ", ".join(PARAMETERS)
                text = f"parameter {name} of a platform: expected one of {known}"
                raise ManycoreError(text, EXIT_BAD_INPUT)
            if value < 0 or (value == 0 and name in _POSITIVE):
                text = f"parameter {name} of a platform: expected more than 0, found {value:g}"
                raise ManycoreError(text, EXIT_BAD_INPUT)
        changes: dict[str, Any] = dict(values)
        sources = {**self.sources, **dict.fromkeys(values, source)}
        return replace(self, sources=sources, **changes)


PARAMETERS: dict[str, str] = {
    one.name: one.metadata["text"] for one in fields(Target) if "text" in one.metadata
}
_POSITIVE = frozenset({"cpu_count", "speed", "slice_us", "bytes_per_us"})

_OVERHEADS = ("dispatch_us", "publish_us", "receive_us", "switch_us")
_WAKING = ("wake_us", "wake_busy_us", "slice_us")
# Waking was measured on a machine with two CPUs. The others are assumed.
_MEASURED_HERE = ("wake_us", "wake_busy_us")
_ASSUMED = ("dispatch_us", "publish_us", "receive_us", "switch_us", "slice_us")
_DEFAULTS: dict[str, float] = {
    "wake_us": 20.0,
    "wake_busy_us": 4.0,
    "dispatch_us": 100.0,
    "publish_us": 15.0,
    "receive_us": 10.0,
    "switch_us": 2.0,
    "slice_us": 2800.0,
}


def _sources(**names: tuple[str, ...]) -> dict[str, Source]:
    found: dict[str, Source] = {}
    for source in SOURCES:
        for name in names.get(source.replace(" ", "_"), ()):
            found[name] = source  # type: ignore[assignment]
    return found


HOST = Target(
    "host",
    "host",
    "memory",
    _sources(chosen=("speed", *_ASSUMED), measured_here=_MEASURED_HERE),
    **_DEFAULTS,
)
# Nothing about the speed of cores and network is published.
COOLIDGE = Target(
    "coolidge",
    "cores",
    "bus",
    _sources(unknown=("speed", *_OVERHEADS, *_WAKING, "message_us", "bytes_per_us")),
    speed=0.25,
    message_us=2.0,
    bytes_per_us=4000.0,
    **_DEFAULTS,
)
BOSTAN = Target(
    "bostan",
    "cores",
    "bostan",
    _sources(
        unknown=("speed", *_OVERHEADS, *_WAKING),
        fitted=("message_us",),
        published=("bytes_per_us",),
    ),
    speed=0.1,
    **_DEFAULTS,
)
TARGETS = {target.name: target for target in (HOST, COOLIDGE, BOSTAN)}
