# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The laws of planning and following equal formulas that are computed in another way."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from rmw_manycore_py.papers.roslite.laws.lanes import (
    NONE,
    Place,
    Waypoints,
    braked,
    closest_waypoint,
    nearest_lane,
)
from rmw_manycore_py.papers.roslite.laws.obstacles import (
    StopRule,
    blocked_waypoint,
    points_on_map,
    stopped_before,
)
from rmw_manycore_py.papers.roslite.laws.pure_pursuit import (
    PursuitRule,
    curvature_1_m,
    lookahead_m,
    pursue,
    target,
)
from rmw_manycore_py.papers.roslite.laws.twist import FilterRule, TwistFilter

pytestmark = pytest.mark.unit

COUNT = 300


def straight(length: int, speed_m_s: float = 3.0, y_m: float = 0.0) -> Waypoints:
    """Return a lane along x with a waypoint each metre."""
    zeros = np.zeros(length)
    return Waypoints(np.arange(length, dtype=float), zeros + y_m, zeros, zeros + speed_m_s)


def bent(generator: np.random.Generator) -> Waypoints:
    """Return a lane of random curvature, and random spacing below a metre."""
    steps = generator.uniform(0.2, 0.9, 80)
    yaw = np.cumsum(generator.uniform(-0.05, 0.05, 80))
    places = np.cumsum(steps * np.exp(1j * yaw))
    return Waypoints(places.real, places.imag, yaw, generator.uniform(1.0, 5.0, 80))


def rows(*ranges: tuple[float, float]) -> list[tuple[float, ...]]:
    generator = np.random.default_rng(20)
    columns = [generator.uniform(low, high, COUNT) for low, high in ranges]
    return [tuple(row) for row in np.column_stack(columns).tolist()]


def test_a_braked_lane_can_be_driven_with_the_deceleration():
    """Integrate time steps from the stop backwards, instead of the closed form."""
    lane = braked(straight(30, speed_m_s=4.0), 25, 0.7)
    place_m, speed_m_s, step_s = 25.0, 0.0, 1e-4
    speeds = {}
    while place_m > 0.0:
        speed_m_s += 0.7 * step_s
        place_m -= speed_m_s * step_s
        speeds.setdefault(math.ceil(place_m), speed_m_s)
    expected = [min(speeds[number], 4.0) for number in range(25)]
    assert lane.speed_m_s[:25] == pytest.approx(expected, abs=1e-3)
    assert list(lane.speed_m_s[25:]) == [0.0] * 5


def test_the_closest_waypoint_heads_the_vehicles_way():
    generator = np.random.default_rng(1)
    for x, y, yaw in rows((-5, 40), (-8, 8), (-4, 4)):
        lane = bent(generator)
        candidates = [
            (abs(complex(wx, wy) - complex(x, y)), number)
            for number, (wx, wy, wyaw) in enumerate(
                zip(lane.x_m, lane.y_m, lane.yaw_rad, strict=True)
            )
            if (cmath.exp(1j * wyaw) * cmath.exp(-1j * yaw)).real > 0.0
        ]
        expected = min(candidates)[1] if candidates else NONE
        assert closest_waypoint(lane, Place(x, y, yaw)) == expected


def test_the_nearest_lane_is_chosen_and_none_against_its_direction():
    lanes = [straight(10, y_m=0.0), straight(10, y_m=3.0)]
    assert nearest_lane(lanes, Place(4.2, 2.0, 0.1)) == (1, 4)
    assert nearest_lane(lanes, Place(4.2, 1.0, 0.1)) == (0, 4)
    assert nearest_lane(lanes, Place(4.2, 1.0, math.pi)) == (NONE, NONE)
    assert nearest_lane([], Place(0.0, 0.0, 0.0)) == (NONE, NONE)


def test_the_target_is_on_the_lane_and_on_the_circle():
    generator = np.random.default_rng(2)
    rule_m = 6.0
    for _ in range(COUNT):
        lane = bent(generator)
        place = Place(float(lane.x_m[0]), float(lane.y_m[0]), 0.0)
        x, y = target(lane, place, rule_m)
        assert math.hypot(x - place.x_m, y - place.y_m) == pytest.approx(rule_m)
        ends = np.stack([lane.x_m, lane.y_m], axis=1)
        to_start = np.hypot(*(ends[:-1] - (x, y)).T)
        to_end = np.hypot(*(ends[1:] - (x, y)).T)
        lengths = np.hypot(*np.diff(ends, axis=0).T)
        assert (to_start + to_end - lengths).min() == pytest.approx(0.0, abs=1e-9)


def test_the_target_of_a_lane_that_ends_is_its_end():
    assert target(straight(4), Place(0.0, 1.0, 0.0), 20.0) == (3.0, 0.0)
    assert target(straight(1), Place(0.0, 1.0, 0.0), 20.0) == (0.0, 0.0)


def test_the_arc_ends_at_the_target():
    """Follow the arc, by rotation about its centre, for as long as the chord asks for."""
    for x, y, yaw, ahead, left in rows((-9, 9), (-9, 9), (-3, 3), (2, 20), (-6, 6)):
        goal = complex(x, y) + complex(ahead, left) * cmath.exp(1j * yaw)
        curvature = curvature_1_m(Place(x, y, yaw), goal.real, goal.imag)
        turned = 2.0 * cmath.phase(complex(ahead, left))
        if abs(curvature) < 1e-6:
            continue
        centre = complex(x, y) + 1j * cmath.exp(1j * yaw) / curvature
        end = centre + (complex(x, y) - centre) * cmath.exp(1j * turned)
        assert abs(end - goal) == pytest.approx(0.0, abs=1e-6)


def test_what_is_pursued():
    rule = PursuitRule()
    assert [lookahead_m(v, rule) for v in (0.0, 2.0, 3.5, 50.0)] == [6.0, 6.0, 7.0, 100.0]
    found = pursue(straight(40, speed_m_s=3.0), Place(0.0, -1.0, 0.0), 2.0, rule)
    assert found.speed_m_s == 3.0
    assert found.curvature_1_m == pytest.approx(2.0 * 1.0 / 36.0)
    assert found.yaw_rate_rad_s == pytest.approx(3.0 * found.curvature_1_m)
    # To the second waypoint it is sqrt(2) m: v = v0 + a t and s = (v + v0) / 2 t.
    time_s = math.sqrt(2.0) / 2.5
    assert found.acceleration_m_s2 == pytest.approx((3.0 - 2.0) / time_s)
    assert math.tan(found.steering_rad) == pytest.approx(2.7 * found.curvature_1_m)


def test_points_are_moved_to_the_map_and_those_too_low_or_high_are_left_out():
    rule = StopRule()
    for x, y, yaw, ahead, left in rows((-9, 9), (-9, 9), (-3, 3), (-20, 20), (-6, 6)):
        points = np.float32([[ahead, left, 0.0], [1, 1, -1.8], [1, 1, 0.3]])
        expected = complex(x, y) + complex(*points[0, :2].tolist()) * cmath.exp(1j * yaw)
        ((found_x, found_y),) = points_on_map(points, Place(x, y, yaw), rule)
        assert complex(found_x, found_y) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("count", "aside_m", "blocked"), [(10, 1.2, 20), (9, 1.2, NONE)])
def test_a_waypoint_is_blocked_by_enough_points_in_range(count, aside_m, blocked):
    obstacle = np.tile([20.0, aside_m], (count, 1))
    assert blocked_waypoint(straight(40), obstacle, StopRule()) == blocked
    assert blocked_waypoint(straight(40), obstacle + np.array([0.0, 0.2]), StopRule()) == NONE
    assert blocked_waypoint(straight(40), np.zeros((0, 2)), StopRule()) == NONE


def test_the_vehicle_stops_ten_metres_before_an_obstacle():
    lane = stopped_before(straight(40), 25, StopRule())
    assert int(np.flatnonzero(lane.speed_m_s == 0.0)[0]) == 15
    assert float(lane.speed_m_s[14]) == pytest.approx(math.sqrt(2 * 0.8 * 1.0))
    assert stopped_before(straight(40), 5, StopRule()).speed_m_s[0] == 0.0


def test_the_filter_limits_lateral_acceleration_and_smooths():
    for speed, rate, gain in rows((0, 20), (-3, 3), (0, 1)):
        limited = min(speed, 5.0 / abs(rate))
        assert TwistFilter(FilterRule())(speed, rate) == pytest.approx((limited, rate))
        smooth = TwistFilter(FilterRule(5.0, gain, gain))
        for _ in range(20):
            found = smooth(speed, rate)
        share = 1.0 - gain**20  # of a step, after twenty
        assert found == pytest.approx((share * limited, share * rate))
    assert TwistFilter(FilterRule(gain_speed=0.9))(7.0, 0.0) == (7.0, 0.0)
