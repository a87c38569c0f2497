# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Converts the tags of XML and YAML launch files to actions."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.validation import describe
from rmw_manycore_py.mapfile.launch_file import actions as a
from rmw_manycore_py.mapfile.launch_file import composition as c
from rmw_manycore_py.mapfile.launch_file import events as e
from rmw_manycore_py.mapfile.launch_file import process_actions as x
from rmw_manycore_py.mapfile.launch_file import ros_actions as r
from rmw_manycore_py.mapfile.launch_file import settings as t
from rmw_manycore_py.mapfile.launch_file import text
from rmw_manycore_py.mapfile.launch_file.elements import Element
from rmw_manycore_py.mapfile.launch_file.include import (
    IncludeLaunchDescription,
    LaunchDescriptionSource,
)
from rmw_manycore_py.mapfile.launch_file.parameters import ParameterFile, ParameterValue
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import TextSubstitution
from rmw_manycore_py.mapfile.launch_file.typed_values import BOOL, KINDS, STR, Parts

Make = Callable[[Element], a.Action]
_OPTIONS = (
    *("output", "emulate_tty", "respawn", "respawn_delay", "respawn_max_retries", "cwd"),
    *("sigterm_timeout", "sigkill_timeout"),
)


def description(element: Element) -> a.LaunchDescription:
    """Return the actions of a <launch> tag."""
    element.get("version")
    return a.LaunchDescription(_actions(element))


def _actions(element: Element) -> list[a.Action]:
    children, element.children = element.children, []
    made = [_action(child) for child in children]
    element.check_all_used()
    return made


def _action(element: Element) -> a.Action:
    make = _TAGS.get(element.tag)
    if make is None:
        raise element.problem(f"one of the tags {', '.join(_TAGS)}", f"'{element.tag}'")
    try:
        condition = _condition(element)
        action = make(element)
        action.line, action.condition = element.line, condition
        element.check_all_used()
    except LaunchFileError as refused:
        raise MapfileError(refused.at(element.file, element.line)) from refused
    return action


def _condition(element: Element) -> a.Condition | None:
    holds, fails = _text(element.get("if")), _text(element.get("unless"))
    if holds is not None and fails is not None:
        raise element.problem("either 'if' or 'unless'", "both")
    if holds is not None:
        return a.IfCondition(holds)
    return None if fails is None else a.UnlessCondition(fails)


def _text(value: Any) -> text.Parts | None:
    return None if value is None else text.parse(_plain(value))


def _plain(value: Any) -> str:
    """Return a scalar attribute as text, as XML has it."""
    if isinstance(value, (dict, list)):
        raise LaunchFileError("a text or a number", describe(value))
    return str(value).lower() if isinstance(value, bool) else str(value)


def _arg(element: Element) -> a.Action:
    choices = [_plain(child.require("value")) for child in element.take("choice")]
    return a.DeclareLaunchArgument(
        _plain(element.require("name")),
        default_value=_text(element.get("default")),
        description=element.get("description"),
        choices=choices or None,
    )


def _node(element: Element) -> a.Action:
    return r.Node(**_node_attributes(element))


def _node_attributes(element: Element) -> dict[str, Any]:
    element.get("exec_name")
    return {
        "package": _text(element.get("pkg")),
        "executable": _text(element.require("exec")),
        "name": _text(element.get("name")),
        "namespace": _text(element.get("namespace", "ns")),
        "arguments": _words(element.get("args")),
        "ros_arguments": _words(element.get("ros_args")),
        "parameters": [_parameter(child) for child in element.take("param")],
        "remappings": _pairs(element.take("remap"), "from", "to"),
        "additional_env": dict(_pairs(element.take("env"), "name", "value")),
        **_options(element),
    }


def _container(element: Element) -> a.Action:
    components = [_component(child) for child in element.take("composable_node")]
    attributes = _node_attributes(element)
    attributes["namespace"] = attributes["namespace"] or ""
    return c.ComposableNodeContainer(composable_node_descriptions=components, **attributes)


def _load(element: Element) -> a.Action:
    components = [_component(child) for child in element.take("composable_node")]
    target = _text(element.require("target"))
    return c.LoadComposableNodes(composable_node_descriptions=components, target_container=target)


def _component(element: Element) -> c.ComposableNode:
    component = c.ComposableNode(
        package=_text(element.require("pkg")),
        plugin=_text(element.require("plugin")),
        name=_text(element.get("name")),
        namespace=_text(element.get("namespace", "ns")),
        parameters=[_parameter(child) for child in element.take("param")],
        remappings=_pairs(element.take("remap"), "from", "to"),
        extra_arguments=[
            {name: value} for name, value in _pairs(element.take("extra_arg"), "name", "value")
        ],
        condition=_condition(element),
    )
    component.line = element.line
    element.check_all_used()
    return component


def _words(line: Any) -> list[text.Parts]:
    return [] if line is None else text.split_words(text.parse(_plain(line)))


def _options(element: Element) -> dict[str, Any]:
    options: dict[str, Any] = {name: _text(element.get(name)) for name in _OPTIONS}
    on_exit = _text(element.get("on_exit"))
    if on_exit is not None:
        words = "".join(getattr(part, "text", "?") for part in on_exit)
        if words != "shutdown":
            raise element.problem("on_exit to be 'shutdown'", repr(words))
        options["on_exit"] = [e.EndLaunch()]
    return {**options, "prefix": _text(element.get("launch-prefix"))}


def _pairs(elements: list[Element], first: str, second: str) -> list[tuple[str, Any]]:
    pairs = []
    for element in elements:
        pairs.append((_plain(element.require(first)), _text(element.require(second))))
        element.check_all_used()
    return pairs


def _parameter(element: Element) -> Any:
    file = element.get("from")
    if file is not None:
        allow = _text(element.get("allow_substs"))
        element.check_all_used()
        return ParameterFile(_text(file), allow_substs=allow or False)
    return _named_parameter(element)


def _named_parameter(element: Element) -> dict[Any, Any]:
    name = tuple(text.parse(_plain(element.require("name"))))
    inner = [_named_parameter(child) for child in element.take("param")]
    nested = {key: value for part in inner for key, value in part.items()}
    value = nested or _parameter_value(element)
    element.check_all_used()
    return {name: value}


def _parameter_value(element: Element) -> ParameterValue:
    element.require("value")
    named = element.typed("type", None)
    if named is not None and (not isinstance(named, str) or named not in KINDS):
        raise element.problem(f"one of the types {', '.join(KINDS)}", repr(named))
    kind = KINDS[named] if named else None
    value = element.typed("value", kind)
    if isinstance(value, list):
        value = [_if_substitutions(item) for item in value]
        if len({str if isinstance(item, str) else type(item) for item in value} - {Parts}) > 1:
            raise element.problem("a list of values of one type", repr(value))
    else:
        value = _if_substitutions(value)
    return ParameterValue(value, value_type=kind)


def _if_substitutions(value: Any) -> Any:
    """Return the parts of a text that has substitutions, and any other value as it is."""
    if not isinstance(value, str):
        return value
    parts = text.parse(value)
    if len(parts) == 1 and isinstance(parts[0], TextSubstitution):
        return parts[0].text
    return Parts(tuple(parts))


def _include(element: Element) -> a.Action:
    arguments = _pairs(element.take("arg", "let"), "name", "value")
    source = LaunchDescriptionSource(_text(element.require("file")))
    return IncludeLaunchDescription(source, launch_arguments=arguments)


def _group(element: Element) -> a.Action:
    scoped, forwarding = (element.typed(name, BOOL) for name in ("scoped", "forwarding"))
    keep = dict(_pairs(element.take("keep"), "name", "value"))
    return a.GroupAction(
        _actions(element),
        scoped=True if scoped is None else scoped,
        forwarding=True if forwarding is None else forwarding,
        launch_configurations=keep,
    )


def _executable(element: Element) -> a.Action:
    return x.ExecuteProcess(
        shell=element.typed("shell", BOOL),
        cmd=_words(element.require("cmd")),
        name=_text(element.get("name")),
        additional_env=dict(_pairs(element.take("env"), "name", "value")),
        **_options(element),
    )


def _of_two(make: Callable[..., a.Action], first: str, second: str) -> Make:
    return lambda el: make(_text(el.require(first)), _text(el.require(second)))


def _append_environment(element: Element) -> a.Action:
    return t.AppendEnvironmentVariable(
        _text(element.require("name")),
        _text(element.require("value")),
        prepend=_text(element.get("prepend")) or False,
        separator=_text(element.get("separator")) or os.pathsep,
    )


def _timer(element: Element) -> a.Action:
    element.get("cancel_on_shutdown")
    return a.TimerAction(period=_text(element.require("period")), actions=_actions(element))


def _shutdown(element: Element) -> a.Action:
    element.get("reason")
    return e.EndLaunch()


def _reset(element: Element) -> a.Action:
    keep = dict(_pairs(element.take("keep"), "name", "value"))
    return t.ResetLaunchConfigurations(keep)


def _set_parameter(element: Element) -> a.Action:
    element.require("value")
    value = text.parse(element.typed("value", STR))
    return r.SetParameter(_text(element.require("name")), value)


def _push_namespace(element: Element) -> a.Action:
    return r.PushROSNamespace(_text(element.require("namespace", "ns")))


_TAGS: dict[str, Make] = {
    "arg": _arg,
    "let": _of_two(a.SetLaunchConfiguration, "name", "value"),
    "node": _node,
    "include": _include,
    "group": _group,
    "executable": _executable,
    "push-ros-namespace": _push_namespace,
    "push_ros_namespace": _push_namespace,
    "set_env": _of_two(a.SetEnvironmentVariable, "name", "value"),
    "set_remap": _of_two(r.SetRemap, "from", "to"),
    "set_parameter": _set_parameter,
    "set_parameters_from_file": lambda el: r.SetParametersFromFile(_text(el.require("filename"))),
    "log": lambda el: a.LogInfo(msg=_text(el.require("message"))),
    "timer": _timer,
    "ros_timer": _timer,
    "node_container": _container,
    "load_composable_node": _load,
    "append_env": _append_environment,
    "unset_env": lambda el: t.UnsetEnvironmentVariable(_text(el.require("name"))),
    "reset_env": lambda _e: t.ResetEnvironment(),
    "unset": lambda el: t.UnsetLaunchConfiguration(_text(el.require("name"))),
    "reset": _reset,
    "set_ros_log_dir": lambda el: r.SetROSLogDir(_text(el.require("new_log_dir"))),
    "set_use_sim_time": lambda el: r.SetUseSimTime(_text(el.require("value"))),
    "shutdown": _shutdown,
}
