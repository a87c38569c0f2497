# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What a mapfile may say: Fig. 8 of ROS-lite2, extended; docs/mapfile.md explains every key."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool, StrictInt, StringConstraints

from rmw_manycore_py.mapfile.values import (
    Arguments,
    Command,
    EnvironmentValue,
    InterfaceType,
    MessageType,
    OneOrMore,
    Parameters,
    Size,
)

# Receiver clusters are a mask of 64 bits.
MAX_CLUSTERS = 64
# As many as the registry has places for processes.
MAX_CORES = 1024
# A node without topics of its own takes almost the one; a process can map some dozens of the other.
MIN_SMEM_BYTES = 64 << 10
MAX_SMEM_BYTES = 1 << 40
# The topic table has 32 bits for it.
MAX_TOPIC_DSM_BYTES = (1 << 32) - 1
Positive = Annotated[StrictInt, Field(ge=1)]
CoreNumber = Annotated[StrictInt, Field(ge=0)]
Text = Annotated[str, StringConstraints(min_length=1)]
TopicName = Annotated[str, StringConstraints(pattern=r"^~?/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*$")]
NodeName = Annotated[str, StringConstraints(pattern=r"^(/?[A-Za-z_]\w*)(/[A-Za-z_]\w*)*$")]
# Whatever rcl may know in a rule, but no spaces or dashes: node:~/topic, rosservice:///ns/{node}.
RemapRule = Annotated[str, StringConstraints(pattern=r"^[\w/~:{}]+$")]
Namespace = Annotated[str, StringConstraints(pattern=r"^/?([A-Za-z_]\w*(/[A-Za-z_]\w*)*)?$")]
PlatformName = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_.-]{0,63}$")]
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
    publish: dict[TopicName, MessageType] = Field(
        default_factory=dict, description="Topics published, where the source does not show them"
    )
    subscribe: dict[TopicName, MessageType] = Field(
        default_factory=dict, description="Topics subscribed, where the source does not show them"
    )
    topic_in: dict[TopicName, InterfaceType] = Field(
        default_factory=dict, description="Topics and services received from outside"
    )
    topic_to: dict[TopicName, InterfaceType] = Field(
        default_factory=dict, description="Topics and services sent outside"
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
    topics: dict[TopicName, TopicSection] = Field(
        default_factory=dict, description="Topics whose type or topic DSM size is fixed"
    )
    nodes: Annotated[dict[NodeName, NodeSection], Field(min_length=1)] = Field(
        description="Nodes by name"
    )
