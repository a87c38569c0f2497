# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Opening one end of a transfer: both sides must fit each other."""

from __future__ import annotations

import struct

from rmw_manycore_py.emcos.errors import system_errors
from rmw_manycore_py.emcos.link import Link
from rmw_manycore_py.emcos.memory import remove_names_of_the_dead
from rmw_manycore_py.emcos.rendezvous import meet
from rmw_manycore_py.ros.domain import checked_platform, default_platform
from rmw_manycore_py.transport.arguments import Deadline, checked_name
from rmw_manycore_py.transport.errors import TransportError, TransportTimeoutError, refusal

# Magic and layout version; class of the end; size of its buffer in bytes, 0 without one.
_HELLO = struct.Struct("<8s24sQ")
_MAGIC = b"MCEMCOS1"

COUNTERPARTS = {
    "MessageSender": "MessageReceiver",
    "MessageReceiver": "MessageSender",
    "SessionSender": "SessionReceiver",
    "SessionReceiver": "SessionSender",
    "SegmentWriter": "SegmentReader",
    "SegmentReader": "SegmentWriter",
}


def open_link(
    own_class: str, name: str, platform: str | None, deadline: Deadline, size_bytes: int
) -> Link:
    """Return the link to the other side, which fits this one.

    :raises TransportTimeoutError: if it has not come by the deadline.
    :raises TransportError: if the other side is no counterpart of this one.
    """
    subject = subject_of(own_class, name)
    place = default_platform() if platform is None else checked_platform(platform, "platform")
    hello = _HELLO.pack(_MAGIC, own_class.encode(), size_bytes)
    expected = f"a {COUNTERPARTS[own_class]} of the same name on platform '{place}'"
    remove_names_of_the_dead()
    with system_errors(subject):
        try:
            connection, theirs = meet(place, name, hello, deadline)
        except TimeoutError:
            raise TransportTimeoutError(
                f"{subject}: the other side has not come in time; expected {expected}"
            ) from None
        link = Link(connection, subject)
        try:
            _check(theirs, own_class, subject, size_bytes)
        except TransportError:
            link.close()
            raise
    return link


def subject_of(own_class: str, name: str) -> str:
    """Return what errors call an end.

    :raises TransportError: if the name is invalid.
    """
    if name is None:
        raise refusal("name", "letters, digits and '_', the first no digit", name)
    return f"{own_class} '{checked_name(name)}'"


def _check(theirs: bytes, own_class: str, subject: str, size_bytes: int) -> None:
    if len(theirs) != _HELLO.size or not theirs.startswith(_MAGIC):
        raise TransportError(f"{subject}: the other side is of another version of rmw_manycore")
    _, name, size = _HELLO.unpack(theirs)
    other = name.rstrip(b"\0").decode(errors="replace")
    if other != COUNTERPARTS[own_class]:
        expected = COUNTERPARTS[own_class]
        raise TransportError(f"{subject}: expected a {expected} of this name, found a {other}")
    if size != size_bytes:
        raise TransportError(
            f"{subject}: expected a buffer of {size_bytes} bytes on both sides, "
            f"found {size} on the other one"
        )
