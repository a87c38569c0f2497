# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Platforms by name, or from a file of the user."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Literal

import yaml
from pydantic import BaseModel, ConfigDict, FiniteFloat, ValidationError

from rmw_manycore_py.errors import (
    EXIT_BAD_INPUT,
    FileError,
    ManycoreError,
    Problem,
    invalid_field,
)
from rmw_manycore_py.prediction.target import TARGETS, Cpus, Network, Source, Target

_EXPECTED = "a platform: base, cpus, network, and parameters with value and source"


class _Value(BaseModel):
    model_config = ConfigDict(extra="forbid")
    value: FiniteFloat
    source: Source


class _File(BaseModel):
    """A file; what it lacks is as in its base."""

    model_config = ConfigDict(extra="forbid")
    base: Literal["host", "coolidge", "bostan"]
    cpus: Cpus | None = None
    network: Network | None = None
    parameters: dict[str, _Value] = {}


def target_named(name: str) -> Target:
    """Return a platform by its name, or from a file.

    :raises ManycoreError: if there is neither; FileError if the file is no platform.
    """
    if name in TARGETS:
        return TARGETS[name]
    path = Path(name)
    if not path.is_file():
        known = ", ".join(TARGETS)
        raise ManycoreError(f"platform {name}: expected {known}, or a file", EXIT_BAD_INPUT)
    try:
        content = _File.model_validate(yaml.safe_load(path.read_text(encoding="utf-8")))
    except ValidationError as error:
        raise FileError(Problem(path, 0, *_with_expected(*invalid_field(error)))) from error
    except (yaml.YAMLError, ValueError, OSError) as error:  # ValueError: also of a date, as YAML's
        raise FileError(Problem(path, 0, "", _EXPECTED, str(error))) from error
    base = TARGETS[content.base]
    target = replace(
        base,
        name=path.stem,
        cpus=content.cpus or base.cpus,
        network=content.network or base.network,
    )
    try:
        for parameter, given in content.parameters.items():
            target = target.changed({parameter: given.value}, given.source)
    except ManycoreError as error:
        raise ManycoreError(f"{path}: {error}", error.exit_status) from error
    return target


def _with_expected(key: str, found: str) -> tuple[str, str, str]:
    return key, _EXPECTED, found
