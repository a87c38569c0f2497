# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Ranges of parameters that are not published."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.prediction.target import Target

SPEEDS = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0)
_FACTORS = (1 / 4, 4.0)  # of all other unknown parameters at once


def sweep_of(target: Target) -> Iterator[tuple[str, Target]]:
    """Yield the target under several assumptions; only itself if all of it is known.

    The speed varies first, then everything else that is unknown at the default speed.
    """
    unknown = target.unknown
    if not unknown:
        yield "", target
        return
    if "speed" in unknown:
        for speed in SPEEDS:
            yield f"speed {speed:g}", target.changed({"speed": speed}, "chosen")
    others = [name for name in unknown if name != "speed"]
    for factor in _FACTORS if others else ():
        values = {name: getattr(target, name) * _towards(name, factor) for name in others}
        label = f"speed {target.speed:g}, costs x{factor:g}"
        yield label, target.changed(values, "chosen")


def _towards(name: str, factor: float) -> float:
    """Return the factor of a parameter with which messages cost more."""
    return 1 / factor if name == "bytes_per_us" else factor
