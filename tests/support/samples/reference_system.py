# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The Autoware reference system as its authors describe it, independent of our mapfile."""

from __future__ import annotations

# Kind, period [ms] where the node has one, inputs. Each node's output topic has its name.
SENSORS = {
    "FrontLidarDriver": 100,
    "RearLidarDriver": 100,
    "Lanelet2Map": 100,
    "PointCloudMap": 120,
    "Visualizer": 60,
    "EuclideanClusterSettings": 25,
}
TRANSFORMS = {
    "PointsTransformerFront": "FrontLidarDriver",
    "PointsTransformerRear": "RearLidarDriver",
    "VoxelGridDownsampler": "PointCloudFusion",
    "RayGroundFilter": "PointCloudFusion",
    "PointCloudMapLoader": "PointCloudMap",
    "ObjectCollisionEstimator": "EuclideanClusterDetector",
    "MPCController": "BehaviorPlanner",
    "ParkingPlanner": "Lanelet2MapLoader",
    "LanePlanner": "Lanelet2MapLoader",
}
FUSIONS = {
    "PointCloudFusion": ("PointsTransformerFront", "PointsTransformerRear"),
    "NDTLocalizer": ("VoxelGridDownsampler", "PointCloudMapLoader"),
    "VehicleInterface": ("MPCController", "BehaviorPlanner"),
    "Lanelet2GlobalPlanner": ("Visualizer", "NDTLocalizer"),
    "Lanelet2MapLoader": ("Lanelet2Map", "Lanelet2GlobalPlanner"),
}
CYCLIC = "BehaviorPlanner"
CYCLE_MS = 100
CYCLIC_INPUTS = (
    *("ObjectCollisionEstimator", "NDTLocalizer", "Lanelet2GlobalPlanner", "Lanelet2MapLoader"),
    *("ParkingPlanner", "LanePlanner"),
)
INTERSECTION = "EuclideanClusterDetector"
CONNECTIONS = {
    "RayGroundFilter": "EuclideanClusterDetector",
    "EuclideanClusterSettings": "EuclideanIntersection",
}
COMMANDS = {"VehicleDBWSystem": "VehicleInterface", "IntersectionOutput": "EuclideanIntersection"}

Edges = set[tuple[str, str]]


def subscriptions() -> Edges:
    """Return all subscriptions as pairs of node and topic."""
    return {
        *TRANSFORMS.items(),
        *COMMANDS.items(),
        *((node, topic) for node, topics in FUSIONS.items() for topic in topics),
        *((CYCLIC, topic) for topic in CYCLIC_INPUTS),
        *((INTERSECTION, topic) for topic in CONNECTIONS),
    }


def publishers() -> Edges:
    """Return all publishers as pairs of node and topic."""
    return {
        *((node, node) for node in (*SENSORS, *TRANSFORMS, *FUSIONS, CYCLIC)),
        *((INTERSECTION, topic) for topic in CONNECTIONS.values()),
    }


def rates_hz() -> dict[str, float]:
    """Return how often each topic is published: a fusion waits for its slower input."""
    known = {name: 1000 / period_ms for name, period_ms in SENSORS.items()}
    known[CYCLIC] = 1000 / CYCLE_MS
    waiting = {
        **{node: (topic,) for node, topic in TRANSFORMS.items()},
        **FUSIONS,
        **{output: (topic,) for topic, output in CONNECTIONS.items()},
    }
    while waiting:
        ready = [node for node, topics in waiting.items() if known.keys() >= set(topics)]
        for node in ready:
            known[node] = min(known[topic] for topic in waiting.pop(node))
    return known
