# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Texts that are evaluated while a launch file is read."""

from __future__ import annotations

import os
from collections.abc import Iterable
from functools import wraps
from typing import Any

from typing_extensions import override

from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_BYTES
from rmw_manycore_py.mapfile.launch_file import unavailable
from rmw_manycore_py.mapfile.launch_file.context import LaunchContext
from rmw_manycore_py.mapfile.launch_file.refusals import LaunchFileError, UnavailableError

# Texts of conditions, in lower case.
BOOLEANS = {"true": True, "1": True, "false": False, "0": False}


class Substitution:
    """A text that is evaluated while the launch file is read.

    Where something is missing here, code of a launch file gets a placeholder text: only what uses
    it fails.
    """

    def __init__(self) -> None:
        """Accept the call from subclasses in launch files."""

    def __init_subclass__(cls) -> None:
        """Make the subclass's `perform` return a placeholder for what is missing here."""
        if "perform" in vars(cls):
            original = cls.perform

            @wraps(original)
            def perform_here(self: Substitution, context: LaunchContext) -> str:
                try:
                    return original(self, context)
                except UnavailableError as error:
                    return unavailable.text_for(error)

            cls.perform = perform_here  # type: ignore[method-assign]

    def describe(self) -> str:
        """Return a description, for launch files that print it."""
        return type(self).__name__

    def perform(self, context: LaunchContext) -> str:
        """Evaluate the substitution."""
        raise NotImplementedError


class TextSubstitution(Substitution):
    """Plain text."""

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise LaunchFileError("a text", repr(text))
        self.text = text

    @override
    def perform(self, context: LaunchContext) -> str:
        return self.text


def perform(context: LaunchContext, value: Any) -> str:
    """Evaluate a string, a substitution, or a sequence of these.

    :raises UnavailableError: if the text depends on something missing here.
    """
    return unavailable.available(text_or_missing(context, value))


def text_or_missing(context: LaunchContext, value: Any) -> str:
    """Evaluate as `perform` does, but return a placeholder where that is unavailable here."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if isinstance(value, Substitution):
        return value.perform(context)
    if isinstance(value, Iterable):
        text = "".join(text_or_missing(context, part) for part in value)
        if len(text) > MAX_BYTES:
            raise LaunchFileError(f"a text of at most {MAX_BYTES} characters", str(len(text)))
        return text
    raise LaunchFileError("a string or a substitution", repr(value))


def condition_holds(context: LaunchContext, value: Any) -> bool:
    """Evaluate the condition of an action: true, false, 1 or 0, in any case."""
    text = str(value) if isinstance(value, bool) else perform(context, value)
    holds = BOOLEANS.get(text.strip().lower())
    if holds is None:
        raise LaunchFileError("a condition that is true, false, 1 or 0", repr(text))
    return holds
