# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Images through camera, filter and detector, nodes of rclpy, on a busy machine."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from rmw_manycore_py.bench.contenders import FAST_DDS, INSIDE, TUNED_FAST_DDS, Middleware
from rmw_manycore_py.bench.load import busy
from rmw_manycore_py.bench.rclpy_round_trip import with_malloc_tuning
from rmw_manycore_py.bench.session import Process, Session, usable_cpus

IMAGES = 120
TIMEOUT_S = 120.0
MIDDLEWARES = (with_malloc_tuning(INSIDE, "rmw_manycore"), FAST_DDS, TUNED_FAST_DDS)


@dataclass(frozen=True)
class CameraSettings:
    """What the camera sends."""

    name: str
    width: int
    height: int
    rate_hz: int
    loops_per_cpu: int  # endless processes beside

    @property
    def arguments(self) -> tuple[int, int, int]:
        """Arguments of its node."""
        return self.width, self.height, self.rate_hz


SMALL = CameraSettings("1 MiB at 15 Hz", 683, 512, 15, 3)
LARGE = CameraSettings("5 MP at 60 Hz", 2592, 1944, 60, 0)
CAMERAS = (SMALL, LARGE)


@dataclass(frozen=True)
class Detections:
    """What became of the images of one run."""

    camera: str
    middleware: str
    images: int
    arrived: int
    age_ms: float  # median, from the camera to the detection; NaN if none arrived
    cpu_s: float  # of the detector


def compare(note: Callable[[str], None], images: int = IMAGES) -> Iterator[Detections]:
    """Yield the detections of each camera and middleware, beside endless loops."""
    cpus = sorted(os.sched_getaffinity(0))
    for camera in CAMERAS:
        for middleware in MIDDLEWARES:
            note(f"{camera.name}: {middleware.name}")
            with busy(camera.loops_per_cpu * len(cpus), cpus, TIMEOUT_S):
                yield detections(camera, middleware, images)


def detections(
    camera: CameraSettings, middleware: Middleware, images: int, *, with_filter: bool = True
) -> Detections:
    """Send images through the nodes, which may run on all CPUs."""
    cpus = sorted(os.sched_getaffinity(0))
    with Session(middleware, usable_cpus(), TIMEOUT_S) as session:

        def start(party: int, *words: object) -> Process:
            return session.python("cameras", party, *words, cpus=cpus)

        detector = start(2, "detector", "filter" if with_filter else "camera")
        if with_filter:
            start(1, "filter")
        shooting = start(0, "camera", *camera.arguments, images)
        detector.wait_until_ready()
        shooting.release()
        shooting.wait_until_ready()
        detector.release()
        return _read(camera, middleware, images, detector.finish())


def _read(
    camera: CameraSettings, middleware: Middleware, images: int, found: dict[str, Any]
) -> Detections:
    return Detections(
        camera.name, middleware.name, images, found["detections"], found["age_ms"], found["cpu_s"]
    )
