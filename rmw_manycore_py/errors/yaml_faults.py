# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Why a YAML file has not what is expected, in one line."""

from __future__ import annotations

import yaml


def yaml_fault(error: Exception) -> str:
    """Return what was found in a file whose parsing, or reading by keys, raised an error."""
    if isinstance(error, yaml.MarkedYAMLError) and error.problem_mark is not None:
        return f"no valid YAML in line {error.problem_mark.line + 1}"
    if isinstance(error, (yaml.YAMLError, UnicodeDecodeError)):
        return "no text in YAML"
    if isinstance(error, KeyError) and error.args:
        return f"no key '{error.args[0]}'"
    return "other values"
