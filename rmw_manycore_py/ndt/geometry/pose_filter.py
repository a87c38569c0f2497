# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Extended Kalman filter of a vehicle's pose, from delayed poses and from its speed.

The state is that of Autoware's ekf_localizer without the yaw bias: x, y, yaw, v (m/s), w (rad/s)
in the plane, with constant v and w between measurements; z, roll and pitch are filtered separately.
Unlike Autoware's, the model includes sideways drift: otherwise the estimate of a vehicle that slips
or is carried lags behind, however accurate its measured poses.

The state is at the time of the newest measurement; queries return its prediction. A delayed
measurement is inserted at its time, and later ones are applied again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from rmw_manycore_py.ndt.geometry.arrays import Matrix
from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, to_rpy

X, Y, YAW, V, W = range(5)
UPRIGHT = (2, 3, 4)  # indices of z, roll, pitch in a covariance (6, 6)
PLANAR = (0, 1, 5)  # x, y, yaw


@dataclass(frozen=True)
class FilterOptions:
    """Standard deviations of the process noise after one second, and time limits."""

    stddev_sideways_c: float = 0.5  # m
    stddev_yaw_c: float = 0.005  # rad
    stddev_v_c: float = 3.0  # m/s
    stddev_w_c: float = 1.0  # rad/s
    stddev_upright_c: tuple[float, float, float] = (0.5, 0.05, 0.05)  # m, rad, rad
    history_s: float = 1.0  # maximum delay of a measurement
    ahead_s: float = 0.5  # maximum lead over the clock; less than history_s


@dataclass(frozen=True)
class State:
    """Mean (5) and covariance (5, 5) in the plane; mean (3) and variance (3) of z, roll, pitch."""

    stamp_s: float
    mean: Matrix
    covariance: Matrix
    upright: Matrix
    upright_variance: Matrix

    def pose(self) -> Matrix:
        """Return T_map_base."""
        z, roll, pitch = self.upright
        return from_xyz_rpy((self.mean[X], self.mean[Y], z), (roll, pitch, self.mean[YAW]))

    def pose_covariance(self) -> Matrix:
        """Return the covariance (6, 6) of x, y, z, roll, pitch, yaw."""
        full = np.zeros((6, 6))
        full[np.ix_(PLANAR, PLANAR)] = self.covariance[:3, :3]
        full[UPRIGHT, UPRIGHT] = self.upright_variance
        return full

    def twist_covariance(self) -> Matrix:
        """Return the covariance (6, 6) of the twist; zero except speed along x, rate about z."""
        full = np.zeros((6, 6))
        full[np.ix_((0, 5), (0, 5))] = self.covariance[V:, V:]
        return full


Update = Callable[[State], State]


@dataclass
class PoseFilter:
    """Filters poses and twists; times in seconds."""

    options: FilterOptions = field(default_factory=FilterOptions)
    _applied: list[tuple[State, Update]] = field(default_factory=list)
    _state: State | None = None

    @property
    def is_initialized(self) -> bool:
        """Return whether there is a pose yet."""
        return self._state is not None

    def initialize(self, stamp_s: float, T_map_base: Matrix, covariance: Matrix) -> None:
        """Restart from a pose, assuming standstill."""
        roll, pitch, yaw = to_rpy(T_map_base)
        x, y, z = T_map_base[:3, 3]
        planar = np.diag([0.0, 0.0, 0.0, 100.0, 1.0])
        planar[:3, :3] = covariance[np.ix_(PLANAR, PLANAR)]
        self._applied = []
        self._state = State(
            stamp_s,
            np.array([x, y, yaw, 0.0, 0.0]),
            planar,
            np.array([z, roll, pitch]),
            covariance[UPRIGHT, UPRIGHT],
        )

    def predicted(self, stamp_s: float) -> State:
        """Return the state at a time, but not before the newest measurement."""
        assert self._state is not None
        return _predict(self._state, max(stamp_s, self._state.stamp_s), self.options)

    def is_ahead(self, stamp_s: float, now_s: float) -> bool:
        """Return whether a stamp is too far ahead: applying it would make later ones too old."""
        return stamp_s > now_s + self.options.ahead_s

    def follow_clock(self, now_s: float) -> bool:
        """If the clock has jumped back, move the state to now and return True.

        Assumes that the vehicle has not moved. Otherwise all new measurements would be older than
        the state.
        """
        if self._state is None or not self.is_ahead(self._state.stamp_s, now_s):
            return False
        self._applied = []
        self._state = replace(self._state, stamp_s=now_s)
        return True

    def add_pose(self, stamp_s: float, T_map_base: Matrix, covariance: Matrix) -> bool:
        """Apply a measured pose; return False if it is older than the history."""
        roll, pitch, yaw = to_rpy(T_map_base)
        x, y, z = T_map_base[:3, 3]
        measured, upright = np.array([x, y, yaw]), np.array([z, roll, pitch])
        noise = covariance[np.ix_(PLANAR, PLANAR)]
        upright_noise = covariance[UPRIGHT, UPRIGHT]

        def update(state: State) -> State:
            H = np.eye(3, 5)
            state = _corrected(state, H, measured, noise, angle_row=2)
            return _corrected_upright(state, upright, upright_noise)

        return self._add(stamp_s, update)

    def add_twist(self, stamp_s: float, v_m_s: float, w_rad_s: float, noise: Matrix) -> bool:
        """Apply a measured speed and turn rate with covariance (2, 2)."""
        measured = np.array([v_m_s, w_rad_s])
        H = np.eye(5)[V:]
        return self._add(stamp_s, lambda state: _corrected(state, H, measured, noise))

    def _add(self, stamp_s: float, update: Update) -> bool:
        """Apply an update at its time, then repeat the later ones."""
        assert self._state is not None
        later: list[tuple[float, Update]] = []
        state, applied = self._state, list(self._applied)
        while stamp_s < state.stamp_s:
            if not applied:
                return False
            later.append((state.stamp_s, applied[-1][1]))
            state, _ = applied.pop()
        for time_s, one in [(stamp_s, update), *reversed(later)]:
            applied.append((state, one))
            state = one(_predict(state, time_s, self.options))
        oldest_s = state.stamp_s - self.options.history_s
        self._applied = [entry for entry in applied if entry[0].stamp_s >= oldest_s]
        self._state = state
        return True


def _predict(state: State, stamp_s: float, options: FilterOptions) -> State:
    """Predict: the chord of a circle for the mean, its Jacobian for the covariance."""
    dt = stamp_s - state.stamp_s
    if dt <= 0.0:
        return state
    yaw, v, w = state.mean[YAW], state.mean[V], state.mean[W]
    middle = yaw + 0.5 * w * dt
    mean = state.mean + dt * np.array([v * np.cos(middle), v * np.sin(middle), w, 0.0, 0.0])
    F = np.eye(5)
    F[X, YAW], F[Y, YAW] = -v * dt * np.sin(middle), v * dt * np.cos(middle)
    F[X, V], F[Y, V] = dt * np.cos(middle), dt * np.sin(middle)
    F[X, W], F[Y, W], F[YAW, W] = 0.5 * dt * F[X, YAW], 0.5 * dt * F[Y, YAW], dt
    noise = np.zeros((5, 5))
    sideways = options.stddev_sideways_c * np.array([-np.sin(middle), np.cos(middle)])
    noise[:2, :2] = np.outer(sideways, sideways) * dt
    deviations = (options.stddev_yaw_c, options.stddev_v_c, options.stddev_w_c)
    noise[(YAW, V, W), (YAW, V, W)] = np.square(deviations) * dt
    return State(
        stamp_s,
        mean,
        F @ state.covariance @ F.T + noise,
        state.upright,
        state.upright_variance + np.square(options.stddev_upright_c) * dt,
    )


def _corrected(
    state: State, H: Matrix, measured: Matrix, noise: Matrix, angle_row: int | None = None
) -> State:
    """Apply a linear measurement; wrap the innovation of the angle in `angle_row`."""
    innovation = measured - H @ state.mean
    if angle_row is not None:
        innovation[angle_row] = (innovation[angle_row] + np.pi) % (2.0 * np.pi) - np.pi
    S = H @ state.covariance @ H.T + noise
    gain = np.linalg.solve(S, H @ state.covariance).T
    rest = np.eye(5) - gain @ H
    covariance = rest @ state.covariance @ rest.T + gain @ noise @ gain.T
    mean = state.mean + gain @ innovation
    return State(state.stamp_s, mean, covariance, state.upright, state.upright_variance)


def _corrected_upright(state: State, measured: Matrix, noise: Matrix) -> State:
    gain = state.upright_variance / (state.upright_variance + noise)
    difference = measured - state.upright
    difference[1:] = (difference[1:] + np.pi) % (2.0 * np.pi) - np.pi
    return State(
        state.stamp_s,
        state.mean,
        state.covariance,
        state.upright + gain * difference,
        (1.0 - gain) * state.upright_variance,
    )
