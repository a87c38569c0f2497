# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Other functions and small types of launch used by Python launch files."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from typing import Any

from rmw_manycore_py.mapfile.launch_file.actions import Action
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError
from rmw_manycore_py.mapfile.launch_file.substitution import (
    Substitution,
    TextSubstitution,
    condition_holds,
    text_or_missing,
)
from rmw_manycore_py.mapfile.launch_file.typed_values import kind_of, normalise, perform_typed


class InvalidLaunchFileError(Exception):
    """Launch cannot read a launch file."""


class SubstitutionFailure(RuntimeError):  # noqa: N818  # the name is that of launch
    """A substitution has no value."""


class InvalidConditionExpressionError(Exception):
    """A condition is neither true nor false."""


class LaunchIntrospector:
    """Formats launch descriptions."""

    def format_launch_description(self, launch_description: Any) -> str:
        """Return one line per top-level action."""
        lines = [f"    {type(one).__name__}" for one in launch_description.entities]
        return "\n".join(["<launch_description>", *lines])


class LaunchService:
    """Rejects launch files that run launch themselves."""

    def __init__(self, **_options: Any) -> None:
        raise LaunchFileError("a launch file that returns its description", "one that runs launch")


def normalize_to_list_of_substitutions(subs: Any) -> list[Substitution]:
    """Return text, a substitution, or a sequence of these as a list of substitutions."""
    if isinstance(subs, Substitution):
        return [subs]
    if isinstance(subs, Iterable) and not isinstance(subs, str):
        return [one for sub in subs for one in normalize_to_list_of_substitutions(sub)]
    return [TextSubstitution(text=str(subs))]


def normalize_to_list_of_entities(entities: Any) -> list[Any]:
    """Return one or several actions as a list."""
    return [entities] if isinstance(entities, Action) else list(entities)


def perform_substitutions(context: LaunchContext, subs: Any) -> str:
    """Return the concatenated text of substitutions."""
    return text_or_missing(context, subs)


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Return a value that `perform_typed_substitution` accepts."""
    return normalise(value, kind_of(data_type))


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any) -> Any:
    """Return the value of a substitution, converted to the type."""
    kind = kind_of(data_type)
    return perform_typed(context, normalise(value, kind), kind)


def evaluate_condition_expression(context: LaunchContext, expression: Any) -> bool:
    """Evaluate a condition."""
    return condition_holds(context, expression)


def ensure_argument_type(*_what: Any) -> None:
    """Do nothing: values are checked where they are used."""


def is_a(thing: Any, kind: type) -> bool:
    """Return whether `thing` is an instance of `kind`."""
    return isinstance(thing, kind)


def expose(_name: str) -> Any:
    """Return a no-op decorator: tags of other packages are not supported."""
    return lambda decorated: decorated


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger."""
    return logging.getLogger(name or "launch")
