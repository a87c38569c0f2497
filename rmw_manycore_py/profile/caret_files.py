# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Files that CARET writes: architectures, and reports' statistics of nodes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import yaml
from pydantic import BaseModel, BeforeValidator, Field, RootModel, ValidationError

from rmw_manycore_py.errors import FileError, Problem, invalid_field

Content = TypeVar("Content", bound=BaseModel)
UNDEFINED = "UNDEFINED"


def _number(value: Any) -> Any:
    return None if value == "---" else value


Number = Annotated[float | None, BeforeValidator(_number)]


class ArchitectureCallback(BaseModel):
    """A callback of a node."""

    callback_name: str
    callback_type: Literal["subscription_callback", "timer_callback", "service_callback"]
    symbol: str = ""
    topic_name: str = ""
    service_name: str = ""
    period_ns: int | None = None


class Publish(BaseModel):
    """A topic that a node publishes, and the callbacks that do, if known."""

    topic_name: str
    callback_names: list[str] = Field(default_factory=list)


class Subscribe(BaseModel):
    """A topic that a node subscribes, and its callback."""

    topic_name: str
    callback_name: str


class Group(BaseModel):
    """A callback group."""

    callback_group_type: str
    callback_group_name: str
    callback_names: list[str] = Field(default_factory=list)


class ArchitectureNode(BaseModel):
    """A node."""

    node_name: str
    callback_groups: list[Group] = Field(default_factory=list)
    callbacks: list[ArchitectureCallback] = Field(default_factory=list)
    publishes: list[Publish] = Field(default_factory=list)
    subscribes: list[Subscribe] = Field(default_factory=list)


class ArchitectureExecutor(BaseModel):
    """An executor."""

    executor_type: str
    executor_name: str
    callback_group_names: list[str] = Field(default_factory=list)


class ChainNode(BaseModel):
    """A node of a named path."""

    node_name: str
    publish_topic_name: str = UNDEFINED
    subscribe_topic_name: str = UNDEFINED


class NamedPath(BaseModel):
    """A chain of nodes."""

    path_name: str
    node_chain: list[ChainNode]


class Architecture(BaseModel):
    """An architecture file."""

    nodes: list[ArchitectureNode]
    executors: list[ArchitectureExecutor] = Field(default_factory=list)
    named_paths: list[NamedPath] = Field(default_factory=list)


class Statistic(BaseModel):
    """Statistics of one quantity, in ms or Hz; None without samples."""

    avg: Number
    min: Number
    max: Number
    p50: Number
    p95: Number
    p99: Number


class CallbackStatistics(BaseModel):
    """Statistics of a callback."""

    Frequency: Statistic
    Period: Statistic
    Latency: Statistic


class NodeStatistics(BaseModel):
    """Statistics of a node's callbacks, by their names."""

    callbacks: dict[str, CallbackStatistics]


class Statistics(RootModel[dict[str, NodeStatistics]]):
    """A file stats_node.yaml: nodes by their names."""


def read(path: Path, kind: type[Content]) -> Content:
    """Read a file of CARET.

    :raises FileError: if it is none.
    """
    try:
        with path.open(encoding="utf-8") as file:
            return kind.model_validate(yaml.load(file, _LOADER))
    except ValidationError as error:
        raise _problem(path, *invalid_field(error)) from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise _problem(path, "", str(error)) from error


# Of libyaml where it is installed: ten times as fast.
_LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def _problem(path: Path, key: str, found: str) -> FileError:
    return FileError(Problem(path, 0, key, "a file that CARET writes", found))
