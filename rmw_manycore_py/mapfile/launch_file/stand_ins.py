# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of `launch` and `launch_ros`, in `sys.modules` of the process that reads a launch file.

They also replace installed packages, so that the meaning of a mapfile does not depend on the
machine.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

from rmw_manycore_py.mapfile.launch_file import actions as a
from rmw_manycore_py.mapfile.launch_file import composition as c
from rmw_manycore_py.mapfile.launch_file import events as e
from rmw_manycore_py.mapfile.launch_file import file_substitutions as f
from rmw_manycore_py.mapfile.launch_file import include as i
from rmw_manycore_py.mapfile.launch_file import parameters as p
from rmw_manycore_py.mapfile.launch_file import process_actions as x
from rmw_manycore_py.mapfile.launch_file import ros_actions as r
from rmw_manycore_py.mapfile.launch_file import settings as t
from rmw_manycore_py.mapfile.launch_file import substitutions as s
from rmw_manycore_py.mapfile.launch_file import utilities as u
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.ros import ament

_PACKAGES = ("launch", "launch_ros", "launch_xml", "launch_yaml")


def _named(*things: Any) -> dict[str, Any]:
    return {thing.__name__: thing for thing in things}


_SOURCES = {
    f"{kind}LaunchDescriptionSource": i.LaunchDescriptionSource
    for kind in ("", "Any", "Python", "FrontendXML", "XML", "YAML", "Frontend")
}
_ACTIONS = _named(
    *(a.DeclareLaunchArgument, a.SetLaunchConfiguration, a.SetEnvironmentVariable, a.GroupAction),
    *(a.OpaqueFunction, a.LogInfo, a.TimerAction, x.ExecuteProcess, i.IncludeLaunchDescription),
    *(t.AppendEnvironmentVariable, t.UnsetEnvironmentVariable, t.UnsetLaunchConfiguration),
    *(t.PushEnvironment, t.PopEnvironment, t.ResetEnvironment, t.PushLaunchConfigurations),
    *(t.PopLaunchConfigurations, t.ResetLaunchConfigurations, e.RegisterEventHandler),
    *(e.UnregisterEventHandler, e.EmitEvent),
) | {"Shutdown": e.EndLaunch, "ExecuteLocal": x.ExecuteProcess}
_SUBSTITUTIONS = _named(
    *(s.TextSubstitution, s.LaunchConfiguration, s.EnvironmentVariable, s.FindExecutable),
    *(s.PathJoinSubstitution, s.ThisLaunchFile, s.ThisLaunchFileDir, s.PythonExpression, s.Command),
    *(s.NotSubstitution, s.AndSubstitution, s.OrSubstitution, s.EqualsSubstitution),
    *(s.NotEqualsSubstitution, s.IfElseSubstitution, s.AllSubstitution, s.AnySubstitution),
    *(f.PathSubstitution, f.StringJoinSubstitution, f.FileContent, f.LaunchLogDir, f.AnonName),
    *(f.BooleanSubstitution, f.LocalSubstitution, u.SubstitutionFailure),
)
_CONDITIONS = _named(
    *(a.IfCondition, a.UnlessCondition, a.LaunchConfigurationEquals),
    *(a.LaunchConfigurationNotEquals, u.evaluate_condition_expression),
    u.InvalidConditionExpressionError,
)
_HANDLERS = _named(
    *(e.OnProcessStart, e.OnProcessExit, e.OnProcessIO, e.OnExecutionComplete, e.OnShutdown),
    e.OnIncludeLaunchDescription,
)
_PROCESS_EVENTS = dict.fromkeys(
    ("ProcessStarted", "ProcessExited", "ProcessIO", "ProcessStdout", "ProcessStderr"), e.Event
) | _named(e.ShutdownProcess, e.SignalProcess)
_UTILITIES = _named(
    *(u.normalize_to_list_of_substitutions, u.normalize_to_list_of_entities),
    *(u.perform_substitutions, u.ensure_argument_type, u.is_a),
)
_TYPED = _named(u.normalize_typed_substitution, u.perform_typed_substitution)
_TYPES = {
    "SomeSubstitutionsType": Any,
    "SomeSubstitutionsType_types_tuple": (str, s.Substitution, list, tuple),
    "SomeEntitiesType": Any,
    "SomeEntitiesType_types_tuple": (a.Action, list, tuple),
}
_ROS_ACTIONS = _named(
    *(r.Node, r.LifecycleNode, c.ComposableNodeContainer, c.LoadComposableNodes, r.SetRemap),
    *(r.PushROSNamespace, r.SetParameter, r.SetParametersFromFile, r.SetUseSimTime),
    *(r.SetROSLogDir, e.LifecycleTransition),
) | {
    "PushRosNamespace": r.PushROSNamespace,
    "RosTimer": a.TimerAction,
    "ROSTimer": a.TimerAction,
}
_ROS_SUBSTITUTIONS = {
    **_named(s.ExecutableInPackage, s.FindPackagePrefix, s.FindPackageShare, f.Parameter),
    "FindPackage": s.FindPackagePrefix,
}
_DESCRIPTIONS = _named(p.Parameter, p.ParameterFile, p.ParameterValue)
_LIFECYCLE = _named(e.ChangeState, e.StateTransition, e.matches_node_name)
_CONTENTS: dict[str, dict[str, Any]] = {
    "launch": {
        **_named(a.LaunchDescription, a.Action, a.Condition, s.Substitution, LaunchContext),
        **_named(e.Event, e.EventHandler, u.LaunchIntrospector, u.LaunchService),
        **_named(u.InvalidLaunchFileError),
        **_TYPES,
        "LaunchDescriptionEntity": a.Action,
        "LaunchDescriptionSource": i.LaunchDescriptionSource,
    },
    "launch.action": _named(a.Action),
    "launch.actions": _ACTIONS,
    "launch.condition": _named(a.Condition),
    "launch.conditions": _CONDITIONS,
    "launch.event": _named(e.Event),
    "launch.event_handler": _named(e.EventHandler),
    "launch.event_handlers": _HANDLERS,
    "launch.events": _named(e.Shutdown, e.matches_action)
    | {"TimerEvent": e.Event, "ExecutionComplete": e.Event},
    "launch.events.matchers": _named(e.matches_action),
    "launch.events.process": _PROCESS_EVENTS,
    "launch.frontend": {"expose_action": u.expose, "expose_substitution": u.expose}
    | {"Entity": Any, "Parser": Any},
    "launch.launch_context": _named(LaunchContext),
    "launch.launch_description": _named(a.LaunchDescription),
    "launch.launch_description_entity": {"LaunchDescriptionEntity": a.Action},
    "launch.launch_description_source": _SOURCES,
    "launch.launch_description_sources": _SOURCES,
    "launch.launch_introspector": _named(u.LaunchIntrospector),
    "launch.launch_service": _named(u.LaunchService),
    "launch.logging": _named(u.get_logger),
    "launch.some_entities_type": _TYPES,
    "launch.some_substitutions_type": _TYPES,
    "launch.substitution": _named(s.Substitution),
    "launch.substitutions": _SUBSTITUTIONS,
    "launch.utilities": _UTILITIES,
    "launch.utilities.type_utils": _TYPED,
    "launch_ros": {},
    "launch_ros.actions": _ROS_ACTIONS,
    "launch_ros.descriptions": _DESCRIPTIONS | _named(c.ComposableNode),
    "launch_ros.event_handlers": _named(e.OnStateTransition),
    "launch_ros.events": _named(e.matches_node_name),
    "launch_ros.events.lifecycle": _LIFECYCLE,
    "launch_ros.events.matchers": _named(e.matches_node_name),
    "launch_ros.parameter_descriptions": _DESCRIPTIONS,
    "launch_ros.substitutions": _ROS_SUBSTITUTIONS,
    "launch_ros.utilities": {},
    "launch_xml": {},
    "launch_xml.launch_description_sources": _SOURCES,
    "launch_yaml": {},
    "launch_yaml.launch_description_sources": _SOURCES,
}
# Modules of launch with one class each, named after the class in lower case.
_ONE_EACH = {
    "launch.actions": _ACTIONS,
    "launch.event_handlers": _HANDLERS,
    "launch.substitutions": _SUBSTITUTIONS,
    "launch_ros.actions": _ROS_ACTIONS,
    "launch_ros.substitutions": _ROS_SUBSTITUTIONS,
}


def install_stand_ins(context: LaunchContext) -> None:
    """Install the stand-ins for `import launch` in this process, which reads the launch file."""
    for name in [name for name in sys.modules if name.split(".")[0] in _PACKAGES]:
        del sys.modules[name]
    for name, content in _CONTENTS.items():
        sys.modules[name] = _module(name, content)
    for package, classes in _ONE_EACH.items():
        for name, thing in classes.items():
            _module_of_one(package, name, thing)
    _make_index_lenient(context)


def _module(name: str, content: Mapping[str, Any]) -> ModuleType:
    module = ModuleType(name)
    module.__path__ = []
    vars(module).update(content)
    sys.modules[name] = module
    parent, _, last = name.rpartition(".")
    if parent and last not in vars(sys.modules[parent]):
        setattr(sys.modules[parent], last, module)
    return module


def _module_of_one(package: str, name: str, thing: Any) -> None:
    words = "".join(f"_{char.lower()}" if char.isupper() else char for char in name)
    _module(f"{package}.{words.lstrip('_')}", {name: thing})


def _make_index_lenient(context: LaunchContext) -> None:
    """Give packages that are not installed a share directory that does not exist.

    This lets a launch file that only looks up such a package be read; what uses its files cannot
    run.
    """
    try:
        import ament_index_python
        from ament_index_python import packages
    except ImportError:
        return
    holders: tuple[Any, ...] = (ament_index_python, packages)
    for holder in holders:
        holder.get_package_prefix = lambda package: str(_prefix(context, package))
        holder.get_package_share_directory = lambda package, **_options: str(
            _prefix(context, package) / "share" / package
        )
        holder.get_package_share_path = lambda package, **_options: (
            _prefix(context, package) / "share" / package
        )


def _prefix(context: LaunchContext, package: str) -> Path:
    found = ament.package_prefix(package)
    if found is not None:
        return found
    nowhere = Path(f"/{package}-is-not-installed")
    if nowhere not in context.missing:
        context.missing.add(nowhere)
        context.notice(
            0, f"the package '{package}' is not installed; what needs it cannot run here"
        )
    return nowhere
