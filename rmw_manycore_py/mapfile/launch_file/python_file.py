# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs Python launch files against stand-ins of `launch` and `launch_ros` that only record.

The stand-ins are used even where the real packages are installed: what a mapfile means does not
depend on the machine.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.launch_file import actions as a
from rmw_manycore_py.mapfile.launch_file import include as i
from rmw_manycore_py.mapfile.launch_file import parameters as p
from rmw_manycore_py.mapfile.launch_file import ros_actions as r
from rmw_manycore_py.mapfile.launch_file import substitutions as s
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.guard import failure, guarded

_PACKAGES = ("launch", "launch_ros", "launch_xml", "launch_yaml")


def _named(*things: Any) -> dict[str, Any]:
    return {thing.__name__: thing for thing in things}


_SOURCES = {
    f"{kind}LaunchDescriptionSource": i.LaunchDescriptionSource
    for kind in ("", "Any", "Python", "FrontendXML", "XML", "YAML", "Frontend")
}
_ACTIONS = _named(
    *(a.DeclareLaunchArgument, a.SetLaunchConfiguration, a.SetEnvironmentVariable, a.GroupAction),
    *(a.OpaqueFunction, a.LogInfo, a.TimerAction, a.ExecuteProcess, i.IncludeLaunchDescription),
)
_SUBSTITUTIONS = _named(
    *(s.TextSubstitution, s.LaunchConfiguration, s.EnvironmentVariable, s.FindExecutable),
    *(s.PathJoinSubstitution, s.ThisLaunchFile, s.ThisLaunchFileDir, s.PythonExpression, s.Command),
    *(s.NotSubstitution, s.AndSubstitution, s.OrSubstitution, s.EqualsSubstitution),
    *(s.NotEqualsSubstitution, s.IfElseSubstitution),
)
_CONDITIONS = _named(
    a.IfCondition, a.UnlessCondition, a.LaunchConfigurationEquals, a.LaunchConfigurationNotEquals
)
_ROS_ACTIONS = _named(
    *(r.Node, r.LifecycleNode, r.ComposableNodeContainer, r.LoadComposableNodes, r.SetRemap),
    *(r.PushROSNamespace, r.SetParameter, r.SetParametersFromFile),
) | {"PushRosNamespace": r.PushROSNamespace}
_ROS_SUBSTITUTIONS = {
    **_named(s.ExecutableInPackage, s.FindPackagePrefix, s.FindPackageShare),
    "FindPackage": s.FindPackagePrefix,
}
_CONTENTS: dict[str, dict[str, Any]] = {
    "launch": {
        **_named(a.LaunchDescription, a.Condition, s.Substitution, LaunchContext),
        "LaunchDescriptionSource": i.LaunchDescriptionSource,
    },
    "launch.actions": _ACTIONS,
    "launch.condition": _named(a.Condition),
    "launch.conditions": _CONDITIONS,
    "launch.launch_context": _named(LaunchContext),
    "launch.launch_description": _named(a.LaunchDescription),
    "launch.launch_description_source": _SOURCES,
    "launch.launch_description_sources": _SOURCES,
    "launch.some_substitutions_type": {"SomeSubstitutionsType": Any},
    "launch.substitution": _named(s.Substitution),
    "launch.substitutions": _SUBSTITUTIONS,
    "launch_ros": {},
    "launch_ros.actions": _ROS_ACTIONS,
    "launch_ros.descriptions": _named(p.ParameterFile, p.ParameterValue)
    | {"ComposableNode": r.ComposableNodeContainer},
    "launch_ros.parameter_descriptions": _named(p.ParameterFile, p.ParameterValue),
    "launch_ros.substitutions": _ROS_SUBSTITUTIONS,
    "launch_xml": {},
    "launch_xml.launch_description_sources": _SOURCES,
    "launch_yaml": {},
    "launch_yaml.launch_description_sources": _SOURCES,
}


@contextmanager
def stand_ins() -> Iterator[None]:
    """Put the stand-ins where `import launch` finds them, and take them away again."""
    real = {name: module for name, module in sys.modules.items() if _is_ours(name)}
    for name in real:
        del sys.modules[name]
    for name, content in _CONTENTS.items():
        sys.modules[name] = _module(name, content)
    try:
        yield
    finally:
        for name in [name for name in sys.modules if _is_ours(name)]:
            del sys.modules[name]
        sys.modules.update(real)


def _is_ours(name: str) -> bool:
    return name.split(".")[0] in _PACKAGES


def _module(name: str, content: Mapping[str, Any]) -> ModuleType:
    module = ModuleType(name)
    module.__path__ = []
    vars(module).update(content)
    parent, _, last = name.rpartition(".")
    if parent:
        setattr(sys.modules[parent], last, module)
    return module


def read_python(path: Path) -> a.LaunchDescription:
    """Run a launch file and return its description."""
    namespace: dict[str, Any] = {"__file__": str(path), "__name__": "launch_file"}
    try:
        code = compile(path.read_bytes(), str(path), "exec")
        exec(code, namespace)
        generate = namespace["generate_launch_description"]
    except KeyError as error:
        expected = "a function generate_launch_description"
        raise MapfileError(Problem(path, 0, "", expected, "none")) from error
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise failure(path, error) from error
    description = guarded(path, generate)
    if not isinstance(description, a.LaunchDescription):
        expected = "a LaunchDescription from generate_launch_description"
        raise MapfileError(Problem(path, 0, "", expected, type(description).__name__))
    return description
