# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Table of topics and their lanes, in a file of the platform's directory shared by all lanes.

There is one file per direction. It is replaced atomically under a lock: readers see the old or the
new state, also if a writer dies.
"""

from __future__ import annotations

import fcntl
import json
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from rmw_manycore_py.native import _transport
from rmw_manycore_py.routes.route import Route


@dataclass
class Share:
    """Owner of a topic, and the progress of a move.

    Sequence numbers are kept by publisher gid. `first` is the first message that the heir has, None
    until the heir is ready; `last` is the last message that the previous owner forwarded. `matched`
    is the number of endpoints outside that the heir is matched with.
    """

    owner: int
    heir: int | None = None
    first: dict[str, int] | None = None
    matched: int = 0
    last: dict[str, int] = field(default_factory=dict)


def name_of(route: Mapping[str, Any]) -> str:
    """Return the key of a topic within its direction, from the fields of its route."""
    return f"{route['inside']} {route['outside']} {route['domain']}"


class LaneTable:
    """Shares of all topics of one direction, by their index in the plan. Thread-safe."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._seen: tuple[int, int] | None = None
        self._reported: tuple[int, int] | None = None
        self._shares: list[Share] = []

    @classmethod
    def of(cls, platform: str, stem: str) -> LaneTable:
        """Return the table of an engine and direction; its file may be missing."""
        directory = Path(_transport.platform_directory(platform))
        return cls(directory / f"lanes-{stem}")

    def join(self, routes: Sequence[Route], lane: int) -> None:
        """Create the file unless it exists for these routes, and abort this lane's moves."""
        names = [name_of(asdict(route)) for route in routes]
        with self._locked():
            data = self._load()
            if data.get("names") != names:
                data = {"names": names, "shares": [asdict(Share(r.lane)) for r in routes]}
            shares = [Share(**share) for share in data["shares"]]
            for share in shares:
                if lane in (share.owner, share.heir):
                    share.heir = share.first = None
            self._store(names, shares)

    @property
    def shares(self) -> list[Share]:
        """Return a read-only copy of the shares; empty without a file."""
        with self._lock:
            stamp = self._stamp()
            if stamp != self._seen:
                self._seen = stamp
                self._shares = [Share(**share) for share in self._load().get("shares", [])]
            return self._shares

    def owners(self) -> dict[str, int]:
        """Return the owner's lane by topic name."""
        data = self._load()
        names, shares = data.get("names", []), data.get("shares", [])
        return {name: share["owner"] for name, share in zip(names, shares, strict=True)}

    def has_changed(self) -> bool:
        """Return whether the file has changed since the last call."""
        before, self._reported = self._reported, self._stamp()
        return self._reported != before

    @contextmanager
    def change(self, index: int) -> Iterator[Share]:
        """Yield the share of a topic for modification, under the lock."""
        with self._locked():
            data = self._load()
            shares = [Share(**share) for share in data["shares"]]
            yield shares[index]
            self._store(data["names"], shares)

    @contextmanager
    def _locked(self) -> Iterator[None]:
        with self._lock, self._path.with_name(f".{self._path.name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            yield

    def _load(self) -> dict[str, list[Any]]:
        try:
            loaded: dict[str, list[Any]] = json.loads(self._path.read_text())
        except OSError:
            return {}
        return loaded

    def _store(self, names: list[str], shares: list[Share]) -> None:
        fresh = self._path.with_name(f".{self._path.name}")
        fresh.write_text(json.dumps({"names": names, "shares": [asdict(s) for s in shares]}))
        fresh.chmod(0o600)
        fresh.rename(self._path)

    def _stamp(self) -> tuple[int, int] | None:
        try:
            stat = self._path.stat()
        except OSError:
            return None
        return stat.st_ino, stat.st_mtime_ns
