# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters of `ndt_scan_matcher`: Autoware's names and defaults, and additional ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from rmw_manycore_py.native.enums import Behaviour, Search, StepRule, VoxelCovariance
from rmw_manycore_py.ndt.nodes.support.declared import parameter

TRANSFORM_PROBABILITY, NEAREST_VOXEL_LIKELIHOOD = 0, 1
FIXED_VALUE, LAPLACE_APPROXIMATION, MULTI_NDT, MULTI_NDT_SCORE = range(4)
VARIANCES = (0.0225, 0.0225, 0.0225, 0.000625, 0.000625, 0.000625)  # m^2, rad^2
DIAGONAL = tuple(VARIANCES[i] if i == j else 0.0 for i in range(6) for j in range(6))


@dataclass(frozen=True)
class MatcherParameters:
    """Autoware's parameters, in its order."""

    base_frame: str = parameter("frame.base_frame", "base_link")
    ndt_base_frame: str = parameter("frame.ndt_base_frame", "ndt_base_link")
    map_frame: str = parameter("frame.map_frame", "map")

    timeout_s: float = parameter("sensor_points.timeout_sec", 1.0, above=0.0)
    required_distance_m: float = parameter("sensor_points.required_distance", 10.0, min_value=0.0)

    trans_epsilon: float = parameter("ndt.trans_epsilon", 0.01, above=0.0, max_value=1.0)
    step_size: float = parameter("ndt.step_size", 0.1, above=0.0, max_value=10.0)
    resolution_m: float = parameter("ndt.resolution", 2.0, min_value=0.1, max_value=100.0)
    max_iterations: int = parameter("ndt.max_iterations", 30, min_value=1, max_value=1000)
    num_threads: int = parameter("ndt.num_threads", 4, min_value=1, max_value=256)
    regularization: bool = parameter("ndt.regularization.enable", False)
    regularization_scale: float = parameter("ndt.regularization.scale_factor", 0.01, min_value=0.0)

    particles: int = parameter(
        "initial_pose_estimation.particles_num", 200, min_value=1, max_value=100000
    )
    startup_trials: int = parameter("initial_pose_estimation.n_startup_trials", 100, min_value=1)

    initial_pose_timeout_s: float = parameter("validation.initial_pose_timeout_sec", 1.0, above=0.0)
    initial_pose_distance_m: float = parameter(
        "validation.initial_pose_distance_tolerance_m", 10.0, above=0.0
    )
    result_distance_m: float = parameter(
        "validation.initial_to_result_distance_tolerance_m", 3.0, above=0.0
    )
    critical_exe_time_ms: float = parameter(
        "validation.critical_upper_bound_exe_time_ms", 100.0, above=0.0
    )
    skipping_publish_num: int = parameter("validation.skipping_publish_num", 5, min_value=1)

    converged_param_type: int = parameter(
        "score_estimation.converged_param_type",
        NEAREST_VOXEL_LIKELIHOOD,
        choices=(TRANSFORM_PROBABILITY, NEAREST_VOXEL_LIKELIHOOD),
    )
    min_transform_probability: float = parameter(
        "score_estimation.converged_param_transform_probability", 3.0, min_value=0.0
    )
    min_nearest_voxel_likelihood: float = parameter(
        "score_estimation.converged_param_nearest_voxel_transformation_likelihood",
        2.3,
        min_value=0.0,
    )
    no_ground: bool = parameter("score_estimation.no_ground_points.enable", False)
    ground_margin_m: float = parameter(
        "score_estimation.no_ground_points.z_margin_for_ground_removal", 0.8
    )

    covariance: tuple[float, ...] = parameter(
        "covariance.output_pose_covariance", DIAGONAL, length=36
    )
    covariance_type: int = parameter(
        "covariance.covariance_estimation.covariance_estimation_type",
        FIXED_VALUE,
        choices=(FIXED_VALUE, LAPLACE_APPROXIMATION, MULTI_NDT, MULTI_NDT_SCORE),
    )
    offsets_x_m: tuple[float, ...] = parameter(
        "covariance.covariance_estimation.initial_pose_offset_model_x",
        (0.0, 0.0, 0.5, -0.5, 1.0, -1.0),
    )
    offsets_y_m: tuple[float, ...] = parameter(
        "covariance.covariance_estimation.initial_pose_offset_model_y",
        (0.5, -0.5, 0.0, 0.0, 0.0, 0.0),
    )
    temperature: float = parameter("covariance.covariance_estimation.temperature", 0.05, above=0.0)
    covariance_scale: float = parameter(
        "covariance.covariance_estimation.scale_factor", 1.0, above=0.0
    )

    update_distance_m: float = parameter("dynamic_map_loading.update_distance", 20.0, above=0.0)
    map_radius_m: float = parameter("dynamic_map_loading.map_radius", 150.0, above=0.0)
    lidar_radius_m: float = parameter("dynamic_map_loading.lidar_radius", 100.0, above=0.0)
    publish_loaded_map: bool = parameter("dynamic_map_loading.publish_loaded_map", False)


Unchosen = Literal[""]  # use the behaviour's value


@dataclass(frozen=True)
class OwnParameters:
    """Parameters that Autoware's node does not have."""

    search: Search = parameter("ndt.search", "radius", choices=("radius", "direct7", "direct1"))
    coarse_levels: tuple[float, ...] = parameter("ndt.coarse_levels", (2.0,))
    wide_levels: tuple[float, ...] = parameter("ndt.wide_levels", (4.0,))
    polish_levels: tuple[float, ...] = parameter("ndt.polish_levels", (0.5,))
    voxel_covariance: VoxelCovariance | Unchosen = parameter(
        "ndt.covariance", "", choices=("", "autoware", "pcl", "pclomp")
    )
    step_rule: StepRule | Unchosen = parameter(
        "ndt.step_rule", "", choices=("", "trust_region", "clamped", "more_thuente")
    )
    outlier_ratio: float = parameter("ndt.outlier_ratio", 0.55, above=0.0, max_value=0.99)
    scan_limit: int = parameter("sensor_points.limit", 200_000, min_value=100, max_value=10_000_000)
    max_matched: int = parameter(
        "sensor_points.max_matched", 30_000, min_value=100, max_value=10_000_000
    )
    deskew: bool = parameter("sensor_points.deskew", False)
    map_path: str = parameter("map_path", "")
    map_leaf_m: float = parameter("map_leaf_size", 0.0, min_value=0.0)
    behaviour: Behaviour = parameter("behaviour", "robust", choices=("robust", "autoware"))
    guess_wait_s: float = parameter(
        "validation.initial_pose_wait_sec", 0.05, min_value=0.0, max_value=10.0
    )
    activated: bool = parameter("activated", False)
    worker_cpus: tuple[int, ...] = parameter("worker_host_cpus", (), whole=True)
    recovery_after_scans: int = parameter("recovery.after_scans", 5, min_value=0, max_value=10_000)
    recovery_radius_m: float = parameter("recovery.radius", 20.0, min_value=5.0, max_value=200.0)
    last_pose_path: str = parameter("last_pose_path", "")
    realtime_priority: int = parameter("realtime_priority", 0, min_value=0, max_value=99)
