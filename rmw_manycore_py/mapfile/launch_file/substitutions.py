# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Stand-ins of the substitutions of ROS 2 launch."""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from typing_extensions import override

from rmw_manycore_py.errors import shorten
from rmw_manycore_py.mapfile.launch_file import expression, unavailable
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError
from rmw_manycore_py.mapfile.launch_file.substitution import BOOLEANS, Substitution, perform
from rmw_manycore_py.mapfile.launch_file.typed_values import is_substitution, truth
from rmw_manycore_py.ros import ament

# Length at which expressions and commands are truncated in errors.
_MAX_QUOTED = 100


class LaunchConfiguration(Substitution):
    """`$(var name)`: a launch argument."""

    def __init__(self, variable_name: Any, *, default: Any = None) -> None:
        self.variable_name, self.default = variable_name, default

    @override
    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.variable_name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self.default is None:
            known = ", ".join(sorted(context.launch_configurations)) or "none"
            raise LaunchFileError(f"a declared launch argument ({known})", f"'{name}'")
        return perform(context, default_parts(self.default))


def default_parts(default: Any) -> list[Any]:
    """Return the parts of a default value, other values than texts as text."""
    is_one = isinstance(default, (str, Substitution)) or not isinstance(default, Iterable)
    items = [default] if is_one else list(default)
    return [item if isinstance(item, (str, Substitution)) else str(item) for item in items]


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
        return self.find(perform(context, self.package))

    def find(self, package_name: str) -> str:
        """Return the directory of a package."""
        return str(ament.package_prefix(package_name) or missing_prefix(package_name))


class FindPackageShare(FindPackagePrefix):
    """`$(find-pkg-share package)`."""

    @override
    def find(self, package_name: str) -> str:
        found = ament.package_share(package_name)
        return str(found or missing_prefix(package_name) / "share" / package_name)


def missing_prefix(package: str) -> Path:
    """Return a placeholder for the prefix of a package that is not installed."""
    return Path(unavailable.text_for(unavailable.missing_package(package)))


class ExecutableInPackage(Substitution):
    """`$(exec-in-pkg executable package)`."""

    def __init__(self, executable: Any, package: Any) -> None:
        self.executable, self.package = executable, package

    @override
    def perform(self, context: LaunchContext) -> str:
        prefix = FindPackagePrefix(self.package).perform(context)
        name = perform(context, self.executable)
        package = perform(context, self.package)
        path = Path(unavailable.available(prefix), "lib", package, name)
        if not os.path.isfile(path):
            raise UnavailableError(f"an executable of the package '{package}'", f"'{name}'")
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
            raise UnavailableError("an executable on the PATH", f"'{name}'")
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
            raise LaunchFileError("a Python expression", f"{quoted(text)}: {error}") from error


class _Logic(Substitution):
    def __init__(self, *operands: Any) -> None:
        self.operands = operands

    @override
    def perform(self, context: LaunchContext) -> str:
        return str(self.holds(context)).lower()

    def holds(self, context: LaunchContext) -> bool:
        raise NotImplementedError

    def values(self, context: LaunchContext) -> list[bool]:
        """Return the values of all operands: each has to be a boolean."""
        return [truth(context, operand) for operand in self.operands]


class NotSubstitution(_Logic):
    """`$(not a)`."""

    def __init__(self, value: Any) -> None:
        super().__init__(value)

    @override
    def holds(self, context: LaunchContext) -> bool:
        return not self.values(context)[0]


class AllSubstitution(_Logic):
    """`$(all a b c)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return all(self.values(context))


class AnySubstitution(_Logic):
    """`$(any a b c)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return any(self.values(context))


class AndSubstitution(AllSubstitution):
    """`$(and a b)`."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(left, right)


class OrSubstitution(AnySubstitution):
    """`$(or a b)`."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(left, right)


class EqualsSubstitution(_Logic):
    """`$(equals a b)`: booleans by their value, numbers by closeness, else texts."""

    def __init__(self, left: Any, right: Any) -> None:
        super().__init__(_as_operand(left), _as_operand(right))

    @override
    def holds(self, context: LaunchContext) -> bool:
        one, other = (perform(context, operand) for operand in self.operands)
        if one.lower() in BOOLEANS and other.lower() in BOOLEANS:
            return BOOLEANS[one.lower()] == BOOLEANS[other.lower()]
        try:
            return math.isclose(float(one), float(other))
        except ValueError:
            return one == other


class NotEqualsSubstitution(EqualsSubstitution):
    """`$(not-equals a b)`."""

    @override
    def holds(self, context: LaunchContext) -> bool:
        return not super().holds(context)


def _as_operand(value: Any) -> Any:
    """Return a substitution as it is, and any other value as text."""
    if is_substitution(value):
        return value
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)


class IfElseSubstitution(Substitution):
    """`$(if condition a b)`."""

    def __init__(self, condition: Any, if_value: Any = "", else_value: Any = "") -> None:
        self.condition, self.if_value, self.else_value = condition, if_value, else_value

    @override
    def perform(self, context: LaunchContext) -> str:
        chosen = self.if_value if truth(context, self.condition) else self.else_value
        return perform(context, chosen)


def quoted(text: str) -> str:
    """Return an expression or a command for an error."""
    return f"'{shorten(text, _MAX_QUOTED)}'"


def _as_list(value: Any) -> list[Any]:
    return [value] if isinstance(value, (str, Substitution)) else list(value)
