# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A course along streets of houses."""

from __future__ import annotations

import numpy as np

from rmw_manycore_py.papers.roslite2.course.directory import Course, mapped, thinned
from rmw_manycore_py.papers.roslite2.course.shape import CourseShape
from rmw_manycore_py.papers.roslite2.course.streets import build_streets
from rmw_manycore_py.papers.roslite2.course.views import StreetView


def synthetic_course(shape: CourseShape, seed: int) -> Course:
    """Return a course of a shape, with its map."""
    generator = np.random.default_rng(seed)
    trajectory = shape.trajectory()
    view = StreetView(build_streets(shape, trajectory, generator))
    return Course(trajectory, thinned(mapped(view, trajectory, generator)), view)
