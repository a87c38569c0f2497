# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""YAML in rosbag2's style."""

from __future__ import annotations

from typing import Any

import yaml


class _Plain(yaml.SafeDumper):
    """Repeats equal data instead of using aliases."""

    def ignore_aliases(self, _data: Any) -> bool:
        return True


def dump(data: Any) -> str:
    """Return data as YAML, in its own order."""
    return str(yaml.dump(data, Dumper=_Plain, sort_keys=False))
