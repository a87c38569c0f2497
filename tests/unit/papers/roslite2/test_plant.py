# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The plant follows commands with its lag, and stops without them."""

from __future__ import annotations

import math

import pytest

from rmw_manycore_py.papers.roslite2.laptop.plant import Plant, PlantOptions

pytestmark = pytest.mark.unit

STEP_S = 0.001


def driven(plant: Plant, speed_m_s: float, rate_rad_s: float, time_s: float) -> Plant:
    """Return the plant after a time of commands, one per millisecond."""
    for step in range(round(time_s / STEP_S)):
        plant.command(step * STEP_S, speed_m_s, rate_rad_s)
        plant.advance(step * STEP_S, STEP_S)
    return plant


def at_origin(**options: float) -> Plant:
    return Plant(PlantOptions(**options), 0.0, 0.0, 0.0)


def test_wheels_lag_as_a_system_of_first_order():
    plant = driven(at_origin(lag_s=0.2), 1.0, 0.0, 0.2)
    assert plant.speed_m_s == pytest.approx(1 - math.exp(-1), abs=1e-6)


def test_a_circle():
    plant = driven(at_origin(lag_s=0.001), 1.0, 0.5, 2 * math.pi)
    assert (plant.x_m, plant.y_m) == pytest.approx((0.0, 4.0), abs=0.02)
    assert plant.yaw_rad == pytest.approx(math.pi, abs=0.01)


def test_without_commands_it_stands_after_half_a_second():
    plant = driven(at_origin(), 1.5, 0.0, 1.0)
    assert not plant.is_timed_out(1.0 + 0.49)
    assert plant.is_timed_out(1.0 + 0.51)
    for step in range(2000):
        plant.advance(1.51 + step * STEP_S, STEP_S)
    assert abs(plant.speed_m_s) < 1e-3


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf])
def test_a_command_that_is_not_finite_is_one_to_stand(wrong):
    plant = driven(at_origin(), 1.0, 0.0, 1.0)
    for command in ((wrong, 0.0), (1.0, wrong)):
        plant.command(1.0, *command)
        plant.advance(1.0, 1.0)
        assert abs(plant.speed_m_s) < 1e-3


def test_it_stands_before_the_first_command():
    plant = at_origin()
    plant.advance(0.0, 1.0)
    assert plant.is_timed_out(0.0)
    assert (plant.x_m, plant.speed_m_s) == (0.0, 0.0)
