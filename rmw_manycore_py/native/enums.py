# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Names of the enumerations of the native modules, in files, parameters and JSON."""

from __future__ import annotations

from typing import Literal

# QoS policies.
Reliability = Literal["best_effort", "reliable"]
Durability = Literal["volatile", "transient_local"]
History = Literal["keep_last", "keep_all"]
Liveliness = Literal["automatic", "manual_by_topic"]

# How a process waits for messages.
WaitMode = Literal["block", "adaptive", "spin"]

# Endpoints. A server subscribes to requests and publishes replies, a client vice versa.
EndpointKind = Literal["publisher", "subscription"]
EndpointRole = Literal["topic", "request", "reply"]
LOSSES = ("lost", "expired", "refused", "dropped")  # counters of messages that did not arrive

# Transfer of a topic's messages to other clusters; see docs/design/transfers.md.
Transfer = Literal["dsm", "message", "session", "async"]

# How subscriptions read large messages of a topic; see docs/how-to/zero_copy.md.
ZeroCopy = Literal["unset", "sole", "read_only", "off"]

# Scan matcher; see MatcherOptions.
Search = Literal["radius", "direct7", "direct1"]
VoxelCovariance = Literal["pcl", "autoware", "pclomp"]
StepRule = Literal["trust_region", "clamped", "more_thuente"]
Behaviour = Literal["robust", "autoware"]
Outcome = Literal[
    "converged", "iteration_limit", "no_overlap", "degenerate", "surpassed", "unfinished"
]
