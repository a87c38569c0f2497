# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Schema of a mapfile: Fig. 8 of ROS-lite2, extended; docs/reference/mapfile has all keys."""

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
from rmw_manycore_py.native.enums import Transfer, WaitMode
from rmw_manycore_py.platform.topology import MACHINE
from rmw_manycore_py.process.scheduling import MAX_PRIORITY, MIN_PRIORITY, REAL_TIME
from rmw_manycore_py.ros.domain import MAX_DOMAIN, PLATFORM_NAME
from rmw_manycore_py.ros.names import MAX_NODE_NAME, MAX_TOPIC_NAME, NAME_PART
from rmw_manycore_py.ros.patterns import is_pattern
from rmw_manycore_py.routes.outside import EngineName, OutsideSettings

# Receiver clusters are a 64-bit mask.
MAX_CLUSTERS = 64
# Process slots of the registry.
MAX_CORES = 1024
# Each is a pair of processes.
MAX_LANES = MAX_CORES // 2
# Of a cluster without nodes; one node of rclpy takes 100 KiB (platform/smem.py).
MIN_SMEM_BYTES = 64 << 10
MAX_SMEM_BYTES = 1 << 40
# Limited by a 32-bit field of the topic table.
MAX_TOPIC_DSM_BYTES = (1 << 32) - 1
# Priorities of eMCOS messages are 0 to this.
MAX_MESSAGE_PRIORITY = 7
Positive = Annotated[StrictInt, Field(ge=1)]
WorkerCount = Annotated[StrictInt, Field(ge=0, le=64)]
CoreNumber = Annotated[StrictInt, Field(ge=0)]
Text = Annotated[str, StringConstraints(min_length=1)]
_PARTS = f"{NAME_PART}(/{NAME_PART})*"
TopicName = Annotated[str, StringConstraints(pattern=f"^~?/?{_PARTS}$", max_length=MAX_TOPIC_NAME)]
# Part of a topic pattern: `*` within one part, `**` for any number of parts.
_PATTERN_PART = r"(\*\*|[A-Za-z_*][A-Za-z0-9_*]*)"
TopicPattern = Annotated[
    str,
    StringConstraints(
        pattern=f"^~?/?{_PATTERN_PART}(/{_PATTERN_PART})*$", max_length=MAX_TOPIC_NAME
    ),
]
OutsideName = Annotated[str, StringConstraints(pattern=f"^/?{_PARTS}$", max_length=MAX_TOPIC_NAME)]
NodeName = Annotated[str, StringConstraints(pattern=f"^/?{_PARTS}$", max_length=MAX_NODE_NAME)]
# Everything rcl may accept in a rule, without spaces and dashes: node:~/topic,
# rosservice:///ns/{node}.
RemapRule = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_/~:{}]+$")]
Namespace = Annotated[str, StringConstraints(pattern=f"^/?({_PARTS})?$")]
HostName = Annotated[str, StringConstraints(pattern=f"^{NAME_PART}$")]
PlatformName = Annotated[str, StringConstraints(pattern=PLATFORM_NAME)]
ReceiveDesign = Literal["queue", "per_topic"]


class Section(BaseModel):
    """Section of a mapfile: immutable; unknown keys are errors."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class PlatformSection(Section):
    """The machine: a profile, optionally with other sizes."""

    profile: Literal["host", "machine", "coolidge", "bostan"] = Field(
        default="host", description="Base profile"
    )
    name: PlatformName | None = Field(
        default=None, description="Name; default: domain-<ROS_DOMAIN_ID>"
    )
    clusters: Annotated[StrictInt, Field(ge=1, le=MAX_CLUSTERS)] | None = Field(
        default=None, description="Number of clusters"
    )
    cores_per_cluster: Annotated[StrictInt, Field(ge=2, le=MAX_CORES)] | None = Field(
        default=None, description="Cores per cluster, including reserved ones"
    )
    smem_size: Annotated[Size, Field(ge=MIN_SMEM_BYTES, le=MAX_SMEM_BYTES)] | None = Field(
        default=None, description="Local memory per cluster, in bytes"
    )

    @model_validator(mode="after")
    def _check_shape(self) -> Self:
        for key in ("clusters", "cores_per_cluster"):
            if self.profile == MACHINE and (found := getattr(self, key)) is not None:
                expected = f"no {key}: the clusters are those of the machine"
                raise refusal(expected, found=found, name=key)
        return self


class TopicSection(Section):
    """A fixed row of the topic table (Fig. 7)."""

    type: MessageType | None = Field(default=None, description="Message type, package/msg/Name")
    topic_dsm_size: Annotated[Size, Field(le=MAX_TOPIC_DSM_BYTES)] | None = Field(
        default=None, description="Size of the topic DSM of each publisher, in bytes"
    )
    transfer: Transfer = Field(
        default="dsm", description="How its messages reach other clusters; dsm is the default"
    )
    priority: Annotated[StrictInt, Field(ge=0, le=MAX_MESSAGE_PRIORITY)] | None = Field(
        default=None, description="Of messages, 0 to 7; the highest is received first"
    )
    synchronous: StrictBool = Field(
        default=False, description="Publishing waits until other clusters have the message"
    )
    zero_copy: Literal["sole", "read_only", "off"] | None = Field(
        default=None, description="How rclpy reads large arrays; default: $MANYCORE_ZERO_COPY"
    )

    @model_validator(mode="after")
    def _check_transfer(self) -> Self:
        if self.transfer != "dsm" and self.topic_dsm_size is None:
            expected = f"a topic_dsm_size, as the topic is transferred ({self.transfer})"
            raise refusal(expected, found=None, name="topic_dsm_size")
        if self.zero_copy not in (None, "off") and self.topic_dsm_size is not None:
            expected = "off, or no topic_dsm_size beside it: such messages are copied"
            raise refusal(expected, found=self.zero_copy, name="zero_copy")
        if self.transfer != "message":
            expected = f"transfer: message beside it, not {self.transfer}"
            if self.priority is not None:
                raise refusal(expected, found=self.priority, name="priority")
            if self.synchronous:
                raise refusal(expected, found=True, name="synchronous")
        return self


Domain = Annotated[StrictInt, Field(ge=0, le=MAX_DOMAIN)]
# At least one message per 11.6 days: keeps periods and timeouts within the clock's range.
Rate = Annotated[float, Field(ge=1e-6, allow_inf_nan=False)]
Timeout = Annotated[float, Field(gt=0, le=1e6, allow_inf_nan=False)]


class QosSection(Section):
    """QoS overrides of the bridge's endpoints of a topic."""

    reliability: Literal["reliable", "best_effort"] | None = Field(
        default=None, description="Default: that of the publishers"
    )
    durability: Literal["volatile", "transient_local"] | None = Field(
        default=None, description="Default: that of the publishers"
    )
    history: Literal["keep_last", "keep_all"] | None = Field(
        default=None, description="keep_last is the default"
    )
    depth: Positive | None = Field(default=None, description="Queue depth, for keep_last")
    deadline: StrictInt | Literal["auto"] | None = Field(
        default=None, description="Nanoseconds, -1 = none; auto = that of the publishers"
    )
    lifespan: StrictInt | Literal["auto"] | None = Field(
        default=None, description="Nanoseconds, -1 = none; auto = that of the publishers"
    )
    liveliness: Literal["automatic", "manual_by_topic", "system_default"] | None = Field(
        default=None, description="Default: that of the publishers"
    )
    liveliness_lease_duration: StrictInt | None = Field(
        default=None, description="Nanoseconds, -1 = none"
    )


class RouteSection(Section):
    """Bridge settings of one topic, service or action."""

    name: OutsideName | None = Field(default=None, description="Full name outside")
    domain: Domain | None = Field(default=None, description="ROS domain outside")
    qos: QosSection = Field(default=QosSection(), description="QoS of the bridge's endpoints")
    max_hz: Rate | None = Field(default=None, description="Maximum messages per second")
    max_size: Size | None = Field(default=None, description="Largest message, in bytes")
    timeout: Timeout | None = Field(default=None, description="Timeout of a request in seconds")


_LINKS = "tcp|udp|tls|quic|ws|unixsock-stream"  # zenoh refuses to start with another one
Locator = Annotated[str, StringConstraints(pattern=rf"^({_LINKS})/\S+$")]


class OutsideSection(Section):
    """What the bridge speaks outside."""

    engine: EngineName = Field(default="fastdds", description="fastdds or zenoh")
    mode: Literal["rmw_zenoh"] | None = Field(
        default=None, description="What zenoh's peers are; rmw_zenoh is the default"
    )
    connect: tuple[Locator, ...] = Field(
        default=(), description="Locators of zenoh routers; default: tcp/localhost:7447"
    )

    @model_validator(mode="after")
    def _check_engine(self) -> Self:
        for key in ("mode", "connect"):
            if self.engine != "zenoh" and key in self.model_fields_set:
                raise refusal(f"no {key} beside the engine {self.engine}", found=key, name=key)
        return self

    @property
    def settings(self) -> OutsideSettings:
        """Settings of a bridge process."""
        return OutsideSettings(self.engine, self.connect)


class BridgeSection(Section):
    """The bridge to external domains."""

    outside: OutsideSection = Field(
        default=OutsideSection(), description="Engine outside; default: Fast DDS"
    )
    domain: Domain | None = Field(
        default=None, description="External ROS domain; default: $ROS_DOMAIN_ID"
    )
    prefix: Namespace | None = Field(default=None, description="Namespace of all external names")
    lanes: Annotated[StrictInt, Field(ge=1, le=MAX_LANES)] = Field(
        default=1, description="Lanes: pairs of bridge processes"
    )
    host_cpu: HostCpus | None = Field(
        default=None, description="Host CPUs of the bridge processes; default: all"
    )
    routes: dict[TopicPattern, RouteSection] = Field(
        default_factory=dict,
        description="Settings of topics, services and actions besides the type",
    )


def _check_crossings(types: dict[str, str | None]) -> dict[str, str | None]:
    """Require a type, except for patterns, which must not have one."""
    for name, type_name in types.items():
        if is_pattern(name) == (type_name is not None):
            expected = "no type: each topic that fits has its own" if type_name else _A_TYPE
            raise refusal(expected, found=type_name, name=name)
    return types


_A_TYPE = "a type such as std_msgs/msg/String or std_srvs/srv/SetBool"
Crossings = Annotated[dict[TopicPattern, InterfaceType | None], AfterValidator(_check_crossings)]


class HostSection(Section):
    """A host that has clusters of the platform."""

    clusters: tuple[Positive, ...] = Field(min_length=1, description="Numbers of its clusters")
    address: Locator = Field(description="Where the other hosts reach it, as tcp/10.0.0.1:7450")


class RespawnSection(Section):
    """Restart of a node that ends by itself."""

    delay: Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)] = Field(
        default=1.0, description="Delay before the restart, in seconds"
    )
    max_retries: Annotated[StrictInt, Field(ge=0)] | None = Field(
        default=None, description="Maximum number of restarts; default: unlimited"
    )


class SchedulingSection(Section):
    """Scheduling policy and priority of a node."""

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
    """A node: placement, command, and topics and services bridged to DDS."""

    cluster: Positive = Field(description="Cluster number, from 1")
    core: CoreNumber | None = Field(
        default=None, description="Core number, from 0; default: the first free core"
    )
    host_cpu: CoreNumber | None = Field(default=None, description="Host CPU; default: the next one")
    module: Text | None = Field(default=None, description="Python module, run with python -m")
    script: Text | None = Field(default=None, description="Python file, relative to the mapfile")
    package: Text | None = Field(default=None, description="ROS package of the executable")
    executable: Text | None = Field(default=None, description="Executable of the package")
    command: Command | None = Field(default=None, description="Any command")
    ros_arguments: StrictBool = Field(
        default=True,
        description="Append --ros-args to the command; false for programs that are no nodes",
    )
    namespace: Namespace | None = Field(default=None, description="Namespace of the node")
    parameters: Parameters = Field(default_factory=dict, description="Parameters by name")
    param_file: OneOrMore = Field(default=(), description="Parameter files")
    remappings: dict[RemapRule, RemapRule] = Field(default_factory=dict, description="From: to")
    arguments: Arguments = Field(default=(), description="Arguments before the ROS arguments")
    env: dict[Text, EnvironmentValue] = Field(default_factory=dict, description="Environment")
    wait: WaitMode | None = Field(
        default=None, description="How the node waits for messages; default: block"
    )
    receive: ReceiveDesign | None = Field(
        default=None, description="How its subscriptions are served; as its program does it"
    )
    scheduling: SchedulingSection | None = Field(
        default=None, description="Policy and priority; default: those of manycore run"
    )
    respawn: Annotated[RespawnSection, OrBool] | None = Field(
        default=None, description="Restart the node when it ends; true, or settings"
    )
    ends_run: StrictBool = Field(default=False, description="Stop the run when the node ends")
    terminal: StrictBool = Field(
        default=False, description="Give the node a terminal, for manycore attach"
    )
    workers: WorkerCount = Field(
        default=0, description="Number of cores in the cluster for workers of the node"
    )
    publish: dict[TopicName, MessageType] = Field(
        default_factory=dict, description="Published topics that the source does not reveal"
    )
    subscribe: dict[TopicName, MessageType] = Field(
        default_factory=dict, description="Subscribed topics that the source does not reveal"
    )
    topic_in: Crossings = Field(
        default_factory=dict, description="Topics and services bridged inward"
    )
    topic_to: Crossings = Field(
        default_factory=dict, description="Topics and services bridged outward"
    )
    service_in: dict[TopicName, ServiceType] = Field(
        default_factory=dict, description="Services of this node called from DDS"
    )
    service_to: dict[TopicName, ServiceType] = Field(
        default_factory=dict, description="DDS services called by this node"
    )
    action_in: dict[TopicName, ActionType] = Field(
        default_factory=dict, description="Actions of this node called from DDS"
    )
    action_to: dict[TopicName, ActionType] = Field(
        default_factory=dict, description="DDS actions called by this node"
    )
    parameters_in: StrictBool = Field(
        default=False, description="Expose the parameter services to DDS"
    )


class MapfileSections(Section):
    """A whole mapfile."""

    platform: PlatformSection = Field(default=PlatformSection(), description="The machine")
    clock: Literal["wall", "virtual"] = Field(
        default="wall", description="Time of the nodes: of the host, or of the platform"
    )
    launch_path: Text | None = Field(
        default=None, description="ROS 2 launch file, relative to the mapfile"
    )
    launch_arguments: dict[Text, EnvironmentValue] = Field(
        default_factory=dict, description="Arguments of the launch file"
    )
    plan: StrictBool = Field(
        default=False,
        description="Check and show nodes that are not installed here; only `run` needs them",
    )
    allow_shared_cores: StrictBool = Field(
        default=False, description="Let several nodes share a core"
    )
    allow_reserved_cores: StrictBool = Field(
        default=False, description="Let nodes run on reserved cores"
    )
    malloc_tuning: StrictBool = Field(
        default=True,
        description="Keep glibc from returning memory to the system after each message",
    )
    bridge: BridgeSection = Field(default=BridgeSection(), description="Bridge to external domains")
    hosts: dict[HostName, HostSection] = Field({}, description="For manycore run --host, by name")
    topics: dict[TopicName, TopicSection] = Field(
        default_factory=dict, description="Topics with a fixed type, topic DSM size or transfer"
    )
    nodes: Annotated[dict[NodeName, NodeSection], Field(min_length=1)] = Field(
        description="Nodes by name"
    )
