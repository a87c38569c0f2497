# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parameters that are given one by one, as options or as the text of a parameter file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import yaml

# A name that rcl takes after -p, and the part of a command line that Linux has room for.
_OPTION_NAME = re.compile(r"[A-Za-z][A-Za-z0-9]*(_[A-Za-z0-9]+|\.[A-Za-z][A-Za-z0-9]*)*")
_MAX_OPTION = 1 << 15


@dataclass(frozen=True)
class Values:
    """Parameters in a section of their own.

    With `by_option` they may also be options -p, which rcl reads as a section for all nodes.
    """

    section: str
    values: Mapping[str, Any]
    by_option: bool

    @property
    def options(self) -> list[str] | None:
        """As options; None if they have to be in a file."""
        texts = {name: parameter_text(value) for name, value in self.values.items()}
        fits = all(_OPTION_NAME.fullmatch(n) and len(t) < _MAX_OPTION for n, t in texts.items())
        if not (self.by_option and fits):
            return None
        return [word for name, text in texts.items() for word in ("-p", f"{name}:={text}")]

    @property
    def text(self) -> str:
        """As the text of a parameter file."""
        lines = [f"{_quoted(self.section)}:", "  ros__parameters:"]
        lines += (f"    {_quoted(n)}: {parameter_text(v)}" for n, v in self.values.items())
        return "\n".join(lines) + "\n"


def parameter_text(value: Any) -> str:
    """Format a value such that rcl parses the same type: strings stay strings."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(parameter_text(item) for item in value)}]"
    return _quoted(value) if isinstance(value, str) else repr(value)


class _Quoted(str):
    """Text that is written in double quotes."""


class _Writer(yaml.SafeDumper):
    """Writes quoted and other texts."""


_Writer.add_representer(
    _Quoted, lambda writer, text: writer.represent_scalar("tag:yaml.org,2002:str", text, style='"')
)


def parameters_yaml(values: Mapping[str, Any]) -> str:
    """Return nested parameters as YAML that rcl reads as the same types, laid out as by ros2cli."""
    return _yaml(_with_quotes(values))


def _with_quotes(value: Any) -> Any:
    """Quote all strings: unquoted ones, rcl and YAML take for numbers by different rules."""
    if isinstance(value, Mapping):
        return {name: _with_quotes(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_with_quotes(part) for part in value]
    return _Quoted(value) if isinstance(value, str) else value


def _quoted(text: str) -> str:
    """Return a text in double quotes, with escapes for what YAML does not allow as it is."""
    return _yaml(_Quoted(text)).removesuffix("\n")


def _yaml(value: Any) -> str:
    """Format as YAML, one line for each scalar."""
    style: dict[str, Any] = {"allow_unicode": True, "default_flow_style": False, "width": 1 << 30}
    return str(yaml.dump(value, Dumper=_Writer, **style))
