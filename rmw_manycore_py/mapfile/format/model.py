# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapfile may say: Fig. 8 of ROS-lite2, extended; docs/mapfile.md explains every key."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    StrictBool,
    StrictInt,
    StringConstraints,
    model_validator,
)
from typing_extensions import Self

from rmw_manycore_py.mapfile.format.values import (
    ActionType,
    Arguments,
    Command,
    EnvironmentValue,
    HostCpus,
    InterfaceType,
    MessageType,
    OneOrMore,
    OrBool,
    Parameters,
    ServiceType,
    Size,
    refusal,
)
from rmw_manycore_py.ros.domain import MAX_DOMAIN, PLATFORM_NAME
from rmw_manycore_py.ros.patterns import is_pattern
from rmw_manycore_py.scheduling import MAX_PRIORITY, MIN_PRIORITY, REAL_TIME

# Receiver clusters are a mask of 64 bits.
MAX_CLUSTERS = 64
# As many as the registry has places for processes.
MAX_CORES = 1024
# Each is a pair of processes.
MAX_LANES = MAX_CORES // 2
# A node without topics of its own takes almost the one; a process can map some dozens of the other.
MIN_SMEM_BYTES = 64 << 10
MAX_SMEM_BYTES = 1 << 40
# The topic table has 32 bits for it.
MAX_TOPIC_DSM_BYTES = (1 << 32) - 1
# rmw's limits, as Fast DDS has them too.
MAX_TOPIC_NAME = 247
MAX_NODE_NAME = 255
Positive = Annotated[StrictInt, Field(ge=1)]
WorkerCount = Annotated[StrictInt, Field(ge=0, le=64)]
CoreNumber = Annotated[StrictInt, Field(ge=0)]
Text = Annotated[str, StringConstraints(min_length=1)]
# Letters of ASCII alone, as rcl has it.
_PART = "[A-Za-z_][A-Za-z0-9_]*"
_PARTS = f"{_PART}(/{_PART})*"
TopicName = Annotated[str, StringConstraints(pattern=f"^~?/?{_PARTS}$", max_length=MAX_TOPIC_NAME)]
# Of a bridge's topics: with `*` for a part of a name, `**` for parts.
_PATTERN_PART = r"(\*\*|[A-Za-z_*][A-Za-z0-9_*]*)"
TopicPattern = Annotated[
    str,
    StringConstraints(
        pattern=f"^~?/?{_PATTERN_PART}(/{_PATTERN_PART})*$", max_length=MAX_TOPIC_NAME
    ),
]
OutsideName = Annotated[str, StringConstraints(pattern=f"^/?{_PARTS}$", max_length=MAX_TOPIC_NAME)]
NodeName = Annotated[str, StringConstraints(pattern=f"^/?{_PARTS}$", max_length=MAX_NODE_NAME)]
# Whatever rcl may know in a rule, but no spaces or dashes: node:~/topic, rosservice:///ns/{node}.
RemapRule = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_/~:{}]+$")]
Namespace = Annotated[str, StringConstraints(pattern=f"^/?({_PARTS})?$")]
PlatformName = Annotated[str, StringConstraints(pattern=PLATFORM_NAME)]
WaitMode = Literal["block", "adaptive", "spin"]


class Section(BaseModel):
    """A part of a mapfile: immutable, and a key it does not know is an error."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class PlatformSection(Section):
    """The machine the nodes are placed on: a profile, or a profile with other sizes."""

    profile: Literal["host", "coolidge", "bostan"] = Field(
        default="host", description="Shape to start from"
    )
    name: PlatformName | None = Field(
        default=None, description="Name, instead of domain-<ROS_DOMAIN_ID>"
    )
    clusters: Annotated[StrictInt, Field(ge=1, le=MAX_CLUSTERS)] | None = Field(
        default=None, description="Number of clusters"
    )
    cores_per_cluster: Annotated[StrictInt, Field(ge=2, le=MAX_CORES)] | None = Field(
        default=None, description="Cores of each cluster, the reserved ones included"
    )
    smem_size: Annotated[Size, Field(ge=MIN_SMEM_BYTES, le=MAX_SMEM_BYTES)] | None = Field(
        default=None, description="Local memory of each cluster, in bytes"
    )


class TopicSection(Section):
    """A row of the topic table that is fixed by hand (Fig. 7)."""

    type: MessageType | None = Field(default=None, description="Message type, package/msg/Name")
    topic_dsm_size: Annotated[Size, Field(le=MAX_TOPIC_DSM_BYTES)] | None = Field(
        default=None, description="Bytes of the ring of each publisher of this topic"
    )


Domain = Annotated[StrictInt, Field(ge=0, le=MAX_DOMAIN)]
# A message in eleven days, and as long a wait: what lies beyond no clock of the bridge can tell.
Rate = Annotated[float, Field(ge=1e-6, allow_inf_nan=False)]
Timeout = Annotated[float, Field(gt=0, le=1e6, allow_inf_nan=False)]


class QosSection(Section):
    """Policies of a topic's endpoints, where they are not to be the publishers' own."""

    reliability: Literal["reliable", "best_effort"] | None = Field(
        default=None, description="Instead of the publishers' own"
    )
    durability: Literal["volatile", "transient_local"] | None = Field(
        default=None, description="Instead of the publishers' own"
    )
    history: Literal["keep_last", "keep_all"] | None = Field(
        default=None, description="keep_last is the default"
    )
    depth: Positive | None = Field(default=None, description="Messages kept, for keep_last")
    deadline: StrictInt | Literal["auto"] | None = Field(
        default=None, description="Nanoseconds, -1 = none; auto = the publishers' own"
    )
    lifespan: StrictInt | Literal["auto"] | None = Field(
        default=None, description="Nanoseconds, -1 = none; auto = the publishers' own"
    )
    liveliness: Literal["automatic", "manual_by_topic", "system_default"] | None = Field(
        default=None, description="Instead of the publishers' own"
    )
    liveliness_lease_duration: StrictInt | None = Field(
        default=None, description="Nanoseconds, -1 = none"
    )


class RouteSection(Section):
    """How one topic, service or action crosses."""

    name: OutsideName | None = Field(default=None, description="Full name outside")
    domain: Domain | None = Field(default=None, description="ROS domain outside")
    qos: QosSection = Field(default=QosSection(), description="QoS of the bridge's endpoints")
    max_hz: Rate | None = Field(default=None, description="Most messages per second")
    max_size: Size | None = Field(default=None, description="Largest message, in bytes")
    timeout: Timeout | None = Field(
        default=None, description="Seconds that a request may stay unanswered"
    )


class BridgeSection(Section):
    """The bridge to DDS domains outside."""

    domain: Domain | None = Field(
        default=None, description="ROS domain outside; $ROS_DOMAIN_ID is the default"
    )
    prefix: Namespace | None = Field(default=None, description="Namespace of all names outside")
    lanes: Annotated[StrictInt, Field(ge=1, le=MAX_LANES)] = Field(
        default=1, description="Pairs of processes"
    )
    host_cpu: HostCpus | None = Field(
        default=None, description="CPUs of the host that its processes run on; all unless named"
    )
    routes: dict[TopicPattern, RouteSection] = Field(
        default_factory=dict, description="Topics, services and actions that need more than a type"
    )


def _check_crossings(types: dict[str, str | None]) -> dict[str, str | None]:
    """Take no type for a pattern, for the graph has it; ask for one otherwise."""
    for name, type_name in types.items():
        if is_pattern(name) == (type_name is not None):
            expected = "no type: each topic that fits has its own" if type_name else _A_TYPE
            raise refusal(expected, found=type_name, name=name)
    return types


_A_TYPE = "a type such as std_msgs/msg/String or std_srvs/srv/SetBool"
Crossings = Annotated[dict[TopicPattern, InterfaceType | None], AfterValidator(_check_crossings)]


class RespawnSection(Section):
    """A node is started again when it ends by itself."""

    delay: Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)] = Field(
        default=1.0, description="Seconds from its end to its next start"
    )
    max_retries: Annotated[StrictInt, Field(ge=0)] | None = Field(
        default=None, description="How often; without end unless given"
    )


class SchedulingSection(Section):
    """How the operating system schedules a node."""

    policy: Literal["fifo", "rr", "other"] = Field(description="Policy of sched(7)")
    priority: Annotated[StrictInt, Field(ge=MIN_PRIORITY, le=MAX_PRIORITY)] | None = Field(
        default=None, description="Priority, for fifo and rr"
    )

    @model_validator(mode="after")
    def _check_priority(self) -> Self:
        if (self.priority is None) == (self.policy in REAL_TIME):
            expected = f"{MIN_PRIORITY} to {MAX_PRIORITY} as priority of {self.policy}"
            if self.policy not in REAL_TIME:
                expected = f"no priority beside the policy {self.policy}"
            raise refusal(expected, found=self.priority, name="priority")
        return self


class NodeSection(Section):
    """A node: where it runs, how it is started, what it says to the outside."""

    cluster: Positive = Field(description="Cluster, counted from 1")
    core: CoreNumber | None = Field(
        default=None, description="Core, counted from 0; the first free one"
    )
    host_cpu: CoreNumber | None = Field(
        default=None, description="CPU of the host, instead of the next"
    )
    module: Text | None = Field(default=None, description="Python module, run with python -m")
    script: Text | None = Field(default=None, description="Python file, relative to the mapfile")
    package: Text | None = Field(default=None, description="ROS package that has the executable")
    executable: Text | None = Field(default=None, description="Executable of the package")
    command: Command | None = Field(default=None, description="Any command")
    ros_arguments: StrictBool = Field(
        default=True, description="Append --ros-args to the command; false for what is not a node"
    )
    namespace: Namespace | None = Field(default=None, description="Namespace of the node")
    parameters: Parameters = Field(default_factory=dict, description="Parameters by name")
    param_file: OneOrMore = Field(default=(), description="Parameter files")
    remappings: dict[RemapRule, RemapRule] = Field(default_factory=dict, description="From: to")
    arguments: Arguments = Field(default=(), description="Arguments before the ROS arguments")
    env: dict[Text, EnvironmentValue] = Field(default_factory=dict, description="Environment")
    wait: WaitMode | None = Field(
        default=None, description="How the node waits; block is the default"
    )
    scheduling: SchedulingSection | None = Field(
        default=None, description="Policy and priority; those of manycore run unless given"
    )
    respawn: Annotated[RespawnSection, OrBool] | None = Field(
        default=None, description="Start the node again when it ends; true, or how"
    )
    terminal: StrictBool = Field(
        default=False, description="Give the node a terminal, for manycore attach"
    )
    workers: WorkerCount = Field(
        default=0, description="Further cores of the cluster, for workers of the node"
    )
    publish: dict[TopicName, MessageType] = Field(
        default_factory=dict, description="Topics published, where the source does not show them"
    )
    subscribe: dict[TopicName, MessageType] = Field(
        default_factory=dict, description="Topics subscribed, where the source does not show them"
    )
    topic_in: Crossings = Field(
        default_factory=dict, description="Topics and services received from outside"
    )
    topic_to: Crossings = Field(
        default_factory=dict, description="Topics and services sent outside"
    )
    service_in: dict[TopicName, ServiceType] = Field(
        default_factory=dict, description="Services of this node that are called from outside"
    )
    service_to: dict[TopicName, ServiceType] = Field(
        default_factory=dict, description="Services outside that this node calls"
    )
    action_in: dict[TopicName, ActionType] = Field(
        default_factory=dict, description="Actions of this node that get goals from outside"
    )
    action_to: dict[TopicName, ActionType] = Field(
        default_factory=dict, description="Actions outside that this node sends goals to"
    )
    parameters_in: StrictBool = Field(
        default=False, description="Parameters are read and set from outside too"
    )


class MapfileSections(Section):
    """A whole mapfile."""

    platform: PlatformSection = Field(default=PlatformSection(), description="The machine")
    launch_path: Text | None = Field(
        default=None, description="ROS 2 launch file, relative to the mapfile"
    )
    launch_arguments: dict[Text, EnvironmentValue] = Field(
        default_factory=dict, description="Arguments of the launch file"
    )
    allow_shared_cores: StrictBool = Field(
        default=False, description="Let several nodes share a core"
    )
    allow_reserved_cores: StrictBool = Field(
        default=False, description="Let nodes run on reserved cores"
    )
    malloc_tuning: StrictBool = Field(
        default=True,
        description="Keep glibc from giving memory back to the system after each message",
    )
    bridge: BridgeSection = Field(
        default=BridgeSection(), description="How topics and services cross to the outside"
    )
    topics: dict[TopicName, TopicSection] = Field(
        default_factory=dict, description="Topics whose type or topic DSM size is fixed"
    )
    nodes: Annotated[dict[NodeName, NodeSection], Field(min_length=1)] = Field(
        description="Nodes by name"
    )
