# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""YAML as rosbag2 writes it."""

from __future__ import annotations

from typing import Any

import yaml


class _Plain(yaml.SafeDumper):
    """Writes what is there twice twice, without aliases."""

    def ignore_aliases(self, _data: Any) -> bool:
        return True


def dump(data: Any) -> str:
    """Return data as text, in its own order."""
    return str(yaml.dump(data, Dumper=_Plain, sort_keys=False))
