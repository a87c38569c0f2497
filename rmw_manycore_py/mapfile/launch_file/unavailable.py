# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Placeholder texts for what this machine lacks, each with the reason.

Code of a launch file may join a placeholder with other texts, and pass it on as a path or a value.
The node that uses the result cannot run here. A process reads one launch file: one registry is
enough.
"""

from __future__ import annotations

import re

from rmw_manycore_py.mapfile.launch_file.refusals import UnavailableError

# Absolute, for os.path.join; no file has such a name.
_ROOT = "/.unavailable/"
_PLACE = re.compile(re.escape(_ROOT) + r"(\d+)")
_errors: list[UnavailableError] = []


def text_for(error: UnavailableError) -> str:
    """Return the placeholder of a missing thing."""
    for number, known in enumerate(_errors):
        if (known.expected, known.found) == (error.expected, error.found):
            return f"{_ROOT}{number}"
    _errors.append(error)
    return f"{_ROOT}{len(_errors) - 1}"


def error_in(text: str) -> UnavailableError | None:
    """Return why a text cannot be used here; None if it can."""
    found = _PLACE.search(text) if _ROOT in text else None
    if found is None or int(found[1]) >= len(_errors):
        return None
    known = _errors[int(found[1])]
    return UnavailableError(known.expected, known.found, known.key)


def available(text: str) -> str:
    """Return the text; raise UnavailableError if it contains a placeholder."""
    error = error_in(text)
    if error is not None:
        raise error
    return text


def missing_package(name: str) -> UnavailableError:
    """Return the error for a package that is not installed."""
    return UnavailableError(
        f"the package '{name}'",
        f"that it is not installed: pip install ./{name}, or source its workspace",
    )
