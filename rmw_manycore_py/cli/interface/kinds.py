# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Filter types by kind: messages, services, actions."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import Any

import click

TITLES = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def kind_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options `-m`, `-s` and `-a`, which set the argument `kinds`."""
    for kind, title in reversed(TITLES.items()):
        function = click.option(
            f"-{kind[0]}",
            f"--only-{kind}s",
            "kinds",
            flag_value=kind,
            multiple=True,
            help=f"{title} only.",
        )(function)
    return function


def kind_of(name: str) -> str:
    """Return "srv" for "std_srvs/srv/SetBool"."""
    return name.split("/")[1]


def of_kinds(names: Iterable[str], kinds: Collection[str]) -> Iterator[str]:
    """Yield the names of types of these kinds; no kinds mean all."""
    return (name for name in names if not kinds or kind_of(name) in kinds)
