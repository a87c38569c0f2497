# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Words that stand for the enumerations of the native modules, in files, parameters and JSON."""

from __future__ import annotations

from typing import Literal

# QoS policies.
Reliability = Literal["best_effort", "reliable"]
Durability = Literal["volatile", "transient_local"]
History = Literal["keep_last", "keep_all"]
Liveliness = Literal["automatic", "manual_by_topic"]

# Endpoints. A server is a subscription of requests with a publisher of replies, a client the
# reverse.
EndpointKind = Literal["publisher", "subscription"]
EndpointRole = Literal["topic", "request", "reply"]

# The scan matcher; MatcherOptions says what they mean.
Search = Literal["radius", "direct7", "direct1"]
VoxelCovariance = Literal["pcl", "autoware", "pclomp"]
StepRule = Literal["trust_region", "clamped", "more_thuente"]
Behaviour = Literal["robust", "autoware"]
Outcome = Literal["converged", "iteration_limit", "no_overlap", "degenerate"]
