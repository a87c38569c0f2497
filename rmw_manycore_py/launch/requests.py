# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Requests of clients to a supervisor: their keys and the types of their values."""

from __future__ import annotations

import base64
from typing import Annotated, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    TypeAdapter,
    ValidationError,
)
from typing_extensions import Self

from rmw_manycore_py.errors import ManycoreError, shorten
from rmw_manycore_py.launch.runs.lines import Message

MAX_STEP_S = 1e9  # its nanoseconds fit with the time that has passed

_MAX_KEY, _MAX_FOUND = 40, 100

Names = Annotated[list[str], Field(min_length=1)]
_Cells = Annotated[int, Field(ge=0, le=0xFFFF)]  # as in struct winsize
Size = Annotated[list[_Cells], Field(min_length=2, max_length=2)]


def _decoded(value: object) -> bytes:
    if not isinstance(value, str):
        raise ValueError("expected a text in Base64")
    return base64.b64decode(value, validate=True)


Keys = Annotated[bytes, BeforeValidator(_decoded)]


class _Strict(BaseModel):
    """Refuses unknown keys: without a misspelt `nodes`, `stop` would stop the whole run."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class State(_Strict):
    """Report the state of each node."""

    do: Literal["state"]


class Stop(_Strict):
    """Stop some nodes; without `nodes`, the whole run."""

    do: Literal["stop"]
    nodes: Names | None = None


class Restart(_Strict):
    """Restart nodes, with `terminal` each with a terminal."""

    do: Literal["restart"]
    nodes: Names
    terminal: bool = False


class Apply(_Strict):
    """Read the mapfile again and apply what changed, or with `check` report it."""

    do: Literal["apply"]
    check: bool = False


class Move(_Strict):
    """Move a node, without `core` to the first free one."""

    do: Literal["move"]
    node: str
    cluster: int
    core: int | None = None


class Follow(_Strict):
    """Report new lines in the logs."""

    do: Literal["follow"]


class Pause(_Strict):
    """Let virtual time stand."""

    do: Literal["pause"]


class Resume(_Strict):
    """Let virtual time go on, until it stands again if one of these is given."""

    do: Literal["resume"]
    for_s: Annotated[float, Field(gt=0, le=MAX_STEP_S)] | None = None
    topic: Annotated[str, StringConstraints(pattern=r"^(/[A-Za-z0-9_/]+)?$")] = ""
    single: bool = False  # to what is due next

    @property
    def has_end(self) -> bool:
        """Whether time stands again."""
        return bool(self.for_s or self.topic or self.single)


class Attach(_Strict):
    """Forward the terminal of a node; from then on the client sends `Typing`."""

    do: Literal["attach"]
    node: str
    size: Size | None = None


class Typing(_Strict):
    """Keys and a new window size of an attached client."""

    input: Keys = b""
    size: Size | None = None

    @classmethod
    def of(cls, message: Message) -> Self:
        """Check a message; raise ManycoreError as `request_of` does."""
        try:
            return cls.model_validate(message)
        except ValidationError as error:
            raise _refused(error) from error


Request = State | Stop | Restart | Apply | Move | Follow | Pause | Resume | Attach
_REQUESTS: TypeAdapter[Request] = TypeAdapter(Annotated[Request, Field(discriminator="do")])


def request_of(message: Message) -> Request:
    """Return the request in a message.

    :raises ManycoreError: names the key that is unknown, missing or has a wrong value.
    """
    try:
        return _REQUESTS.validate_python(message)
    except ValidationError as error:
        raise _refused(error) from error


def _refused(error: ValidationError) -> ManycoreError:
    first = error.errors(include_url=False, include_context=False)[0]
    key = ".".join(shorten(str(part), _MAX_KEY) for part in first["loc"])
    found = shorten(repr(first["input"]), _MAX_FOUND)
    place = f" {key}:" if key else ""
    return ManycoreError(f"invalid request:{place} {shorten(first['msg'], 200)}, found {found}")
