# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of `launch` and `launch_ros`, in `sys.modules` of the process that reads a launch file.

They also replace installed packages, so that the meaning of a mapfile does not depend on the
machine.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

from ament_index_python import packages
from typing_extensions import override

from rmw_manycore_py.mapfile.launch_file import actions as a
from rmw_manycore_py.mapfile.launch_file import composition as c
from rmw_manycore_py.mapfile.launch_file import events as e
from rmw_manycore_py.mapfile.launch_file import file_substitutions as f
from rmw_manycore_py.mapfile.launch_file import include as i
from rmw_manycore_py.mapfile.launch_file import parameters as p
from rmw_manycore_py.mapfile.launch_file import process_actions as x
from rmw_manycore_py.mapfile.launch_file import ros_actions as r
from rmw_manycore_py.mapfile.launch_file import settings as t
from rmw_manycore_py.mapfile.launch_file import substitution as b
from rmw_manycore_py.mapfile.launch_file import substitutions as s
from rmw_manycore_py.mapfile.launch_file import utilities as u
from rmw_manycore_py.mapfile.launch_file.command import Command
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.frame import calling_frame, is_in_try
from rmw_manycore_py.mapfile.launch_file.missing_modules import MissingFinder
from rmw_manycore_py.mapfile.launch_file.placeholders import Unsupported
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
    *(b.TextSubstitution, s.LaunchConfiguration, s.EnvironmentVariable, s.FindExecutable),
    *(s.PathJoinSubstitution, s.ThisLaunchFile, s.ThisLaunchFileDir, s.PythonExpression, Command),
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
    "SomeSubstitutionsType_types_tuple": (str, b.Substitution, list, tuple),
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
        **_named(a.LaunchDescription, a.Action, a.Condition, b.Substitution, LaunchContext),
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
    "launch.frontend": {"expose_action": u.expose, "expose_substitution": u.expose},
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
    "launch.substitution": _named(b.Substitution),
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


class StandInFinder(Loader, MetaPathFinder):
    """Makes every module of launch when it is imported.

    Launch has a module per class, and moves classes between them. So a name is looked up in the
    module, in the packages above it, and then in all of launch. An unknown name fails when used.
    """

    @override
    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname.partition(".")[0] not in _PACKAGES:
            return None
        if not _is_known_module(fullname) and is_in_try(calling_frame()):
            return None
        return ModuleSpec(fullname, self, is_package=True)

    @override
    def exec_module(self, module: ModuleType) -> None:
        vars(module).update(_CONTENTS.get(module.__name__, {}))

        def find_in_module(name: str) -> Any:
            if name.startswith("__"):
                raise AttributeError(name)
            return find_name(f"{module.__name__}.{name}")

        vars(module)["__getattr__"] = find_in_module


def _is_known_module(dotted: str) -> bool:
    """Return whether launch has a module: one listed here, or that of a class of its package."""
    package, _, last = dotted.rpartition(".")
    names = {name.lower() for name in _CONTENTS.get(package, {})}
    return dotted in _CONTENTS or last.removesuffix("_impl").replace("_", "") in names


def find_name(dotted: str) -> Any:
    """Return a module or name of launch, if need be as Unsupported.

    :raises AttributeError: for an unknown name that is imported in a `try`.
    """
    if dotted in _CONTENTS:
        return importlib.import_module(dotted)
    place, _, name = dotted.rpartition(".")
    while place:
        if name in _CONTENTS.get(place, {}):
            return _CONTENTS[place][name]
        place = place.rpartition(".")[0]
    packages = (dotted.partition(".")[0], "launch")  # the others import names of launch
    elsewhere = {
        id(content[name]): content[name]
        for module, content in _CONTENTS.items()
        if module.partition(".")[0] in packages and name in content
    }
    if len(elsewhere) == 1:
        return next(iter(elsewhere.values()))
    if is_in_try(calling_frame()):
        raise AttributeError(name)
    return Unsupported(dotted, find_name)


def install_stand_ins(context: LaunchContext) -> None:
    """Install the stand-ins for `import launch` in this process, which reads the launch file."""
    for name in [name for name in sys.modules if name.split(".")[0] in _PACKAGES]:
        del sys.modules[name]
    sys.meta_path.insert(0, StandInFinder())
    sys.meta_path.append(MissingFinder())
    _make_index_lenient(context)


def _make_index_lenient(context: LaunchContext) -> None:
    """Give packages that are not installed a placeholder directory; a lookup in a `try` fails."""

    def prefix_of(package: str) -> Path:
        if (found := ament.package_prefix(package)) is not None:
            return found
        if is_in_try(calling_frame()):
            raise packages.PackageNotFoundError(package)
        context.notice(
            0, f"the package '{package}' is not installed; what needs it cannot run here"
        )
        return s.missing_prefix(package)

    def share_of(package: str, **_options: Any) -> Path:
        return prefix_of(package) / "share" / package

    for holder in (sys.modules["ament_index_python"], packages):
        lenient: Any = holder
        lenient.get_package_prefix = lambda package: str(prefix_of(package))
        lenient.get_package_share_directory = lambda package, **_options: str(share_of(package))
        lenient.get_package_share_path = share_of
