# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Removes user, host and home directory from a report."""

from __future__ import annotations

import getpass
import os
import re
import socket
from collections.abc import Mapping
from pathlib import Path
from typing import Any

_Rules = list[tuple[re.Pattern[str], str]]

HOME, USER, HOST = "~", "<user>", "<host>"


def anonymous(data: Any, *, keys: bool) -> Any:
    """Return plain data without the home directory, user name and host name.

    :param keys: whether keys may be user-defined names as well.
    """
    return _replaced(data, _rules(), keys)


def _rules() -> _Rules:
    host = socket.gethostname()
    names = {str(Path.home()): HOME, _user(): USER, host: HOST, host.partition(".")[0]: HOST}
    # Match whole words only, so that a user called "ros" does not change /rosout.
    return [
        (re.compile(rf"(?<![\w.-]){re.escape(name)}(?![\w-])"), replacement)
        for name, replacement in names.items()
        if len(name) > 1
    ]


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):  # a container's user may have no name
        return str(os.getuid())


def _replaced(data: Any, rules: _Rules, keys: bool) -> Any:
    if isinstance(data, Mapping):
        return {
            _replaced(key, rules, keys) if keys else key: _replaced(value, rules, keys)
            for key, value in data.items()
        }
    if isinstance(data, list | tuple):
        return [_replaced(value, rules, keys) for value in data]
    if data is None or isinstance(data, int | float):
        return data
    text = str(data)
    for pattern, replacement in rules:
        text = pattern.sub(replacement, text)
    return text
