# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of the substitutions of ROS 2 launch."""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from typing_extensions import override

from rmw_manycore_py.errors import shorten
from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_BYTES
from rmw_manycore_py.mapfile.launch_file import expression
from rmw_manycore_py.mapfile.launch_file.child import ChildBoundError, run_child
from rmw_manycore_py.mapfile.launch_file.context import (
    LaunchContext,
    LaunchFileError,
    MissingText,
    NotInstalledError,
)
from rmw_manycore_py.ros import ament

# Length at which expressions and commands are truncated in errors.
_MAX_QUOTED = 100
COMMAND_TIMEOUT_S = 60


class Substitution:
    """A text that is evaluated while the launch file is read."""

    def __init__(self) -> None:
        """Accept the call from subclasses in launch files."""

    def describe(self) -> str:
        """Return a description, for launch files that print it."""
        return type(self).__name__

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the substitution."""
        raise NotImplementedError


def perform(context: LaunchContext, value: Any) -> str:
    """Evaluate a string, a substitution, or a sequence of these."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Substitution):
        return value.perform(context)
    if isinstance(value, Iterable):
        text = "".join(perform(context, part) for part in value)
        if len(text) > MAX_BYTES:
            raise LaunchFileError(f"a text of at most {MAX_BYTES} characters", str(len(text)))
        return text
    raise LaunchFileError("a string or a substitution", repr(value))


def is_true(context: LaunchContext, value: Any) -> bool:
    """Evaluate a condition: true, false, 1 or 0."""
    text = str(value) if isinstance(value, bool) else perform(context, value)
    if text.strip().lower() not in ("true", "false", "1", "0"):
        raise LaunchFileError("a condition that is true, false, 1 or 0", repr(text))
    return text.strip().lower() in ("true", "1")


class TextSubstitution(Substitution):
    """Plain text."""

    def __init__(self, *, text: str) -> None:
        self.text = text

    @override
    def perform(self, context: LaunchContext) -> str:
        return self.text


class LaunchConfiguration(Substitution):
    """`$(var name)`: a launch argument."""

    def __init__(self, variable_name: Any, *, default: Any = None) -> None:
        self.variable_name, self.default = variable_name, default

    @override
    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.variable_name)
        if name in context.launch_configurations:
            value = context.launch_configurations[name]
            if isinstance(value, MissingText):
                raise value.error
            return value
        if self.default is None:
            known = ", ".join(sorted(context.launch_configurations)) or "none"
            raise LaunchFileError(f"a declared launch argument ({known})", f"'{name}'")
        if isinstance(self.default, (bool, int, float)):
            return str(self.default)
        return perform(context, self.default)


class EnvironmentVariable(Substitution):
    """`$(env NAME default)`."""

    def __init__(self, name: Any, *, default_value: Any = None) -> None:
        self.name, self.default_value = name, default_value

    @override
    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            raise LaunchFileError(f"the environment variable {name} to be set", "it is not")
        return perform(context, self.default_value)


class FindPackagePrefix(Substitution):
    """`$(find-pkg-prefix package)`."""

    def __init__(self, package: Any) -> None:
        self.package = package

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(self.found(context, ament.package_prefix))

    def found(self, context: LaunchContext, find: Callable[[str], Path | None]) -> Path:
        """Return the result of `find` for the package; raise NotInstalledError if it is None."""
        name = perform(context, self.package)
        path = find(name)
        if path is None:
            raise NotInstalledError("an installed package", f"'{name}'")
        return path


class FindPackageShare(FindPackagePrefix):
    """`$(find-pkg-share package)`."""

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(self.found(context, ament.package_share))

    def find(self, package_name: str) -> str:
        """Return the share directory of a package."""
        path = ament.package_share(package_name)
        if path is None:
            raise NotInstalledError("an installed package", f"'{package_name}'")
        return str(path)


class ExecutableInPackage(Substitution):
    """`$(exec-in-pkg executable package)`."""

    def __init__(self, executable: Any, package: Any) -> None:
        self.executable, self.package = executable, package

    @override
    def perform(self, context: LaunchContext) -> str:
        prefix = FindPackagePrefix(self.package).perform(context)
        name = perform(context, self.executable)
        path = Path(prefix, "lib", perform(context, self.package), name)
        if not os.path.isfile(path):
            raise NotInstalledError("an executable of the package", str(path))
        return str(path)


class FindExecutable(Substitution):
    """`$(find-exec name)`."""

    def __init__(self, *, name: Any) -> None:
        self.name = name

    @override
    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        path = shutil.which(name)
        if path is None:
            raise NotInstalledError("an executable on the PATH", f"'{name}'")
        return path


class PathJoinSubstitution(Substitution):
    """Joins its parts with the path separator."""

    def __init__(self, substitutions: Iterable[Any]) -> None:
        self.substitutions = list(substitutions)

    @override
    def perform(self, context: LaunchContext) -> str:
        return os.path.join(*(perform(context, part) for part in self.substitutions))

    def __truediv__(self, part: Any) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, part])


class ThisLaunchFile(Substitution):
    """`$(filename)`."""

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(context.file)


class ThisLaunchFileDir(Substitution):
    """`$(dirname)`."""

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(context.file.parent)


class PythonExpression(Substitution):
    """`$(eval 'expression' 'modules')`."""

    def __init__(self, expression: Any, python_modules: Any = ("math",)) -> None:
        self.expression, self.python_modules = expression, python_modules

    @override
    def perform(self, context: LaunchContext) -> str:
        text = perform(context, self.expression)
        names = [perform(context, name) for name in _as_list(self.python_modules)]
        try:
            return expression.evaluate(text, names)
        except ValueError as error:
            raise LaunchFileError("a Python expression", f"{_quoted(text)}: {error}") from error


class Command(Substitution):
    """`$(command 'line')`: the output of a command."""

    def __init__(self, command: Any, *, on_stderr: Any = "fail") -> None:
        self.command, self.on_stderr = command, on_stderr

    @override
    def perform(self, context: LaunchContext) -> str:
        line = perform(context, self.command)
        try:
            done = run_child(shlex.split(line) or [""], context.environment, COMMAND_TIMEOUT_S)
        except OSError as error:
            found = f"{_quoted(line)}: {error.strerror}"
            raise LaunchFileError("a command that runs", found) from error
        except (ChildBoundError, ValueError) as error:
            raise LaunchFileError("a command that runs", f"{_quoted(line)}: {error}") from error
        if done.returncode != 0 or (done.stderr and perform(context, self.on_stderr) == "fail"):
            found = f"{_quoted(line)}: {done.stderr.strip()}"
            raise LaunchFileError("a command that succeeds", found)
        return done.stdout


class _Logic(Substitution):
    def __init__(self, *operands: Any) -> None:
        self.operands = operands

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(self.holds(context)).lower()

    def holds(self, context: LaunchContext) -> bool:
        raise NotImplementedError


class NotSubstitution(_Logic):
    """`$(not a)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return not is_true(context, self.operands[0])


class AndSubstitution(_Logic):
    """`$(and a b)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return all(is_true(context, operand) for operand in self.operands)


class OrSubstitution(_Logic):
    """`$(or a b)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return any(is_true(context, operand) for operand in self.operands)


class AllSubstitution(AndSubstitution):
    """`$(all a b c)`."""


class AnySubstitution(OrSubstitution):
    """`$(any a b c)`."""


class EqualsSubstitution(_Logic):
    """`$(equals a b)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        one, other = (perform(context, operand) for operand in self.operands)
        return one == other


class NotEqualsSubstitution(EqualsSubstitution):
    """`$(not-equals a b)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return not super().holds(context)


class IfElseSubstitution(Substitution):
    """`$(if condition a b)`."""

    def __init__(self, condition: Any, if_value: Any = "", else_value: Any = "") -> None:
        self.condition, self.if_value, self.else_value = condition, if_value, else_value

    @override
    def perform(self, context: LaunchContext) -> str:
        chosen = self.if_value if is_true(context, self.condition) else self.else_value
        return perform(context, chosen)


def _quoted(text: str) -> str:
    return f"'{shorten(text, _MAX_QUOTED)}'"


def _as_list(value: Any) -> list[Any]:
    return [value] if isinstance(value, (str, Substitution)) else list(value)
