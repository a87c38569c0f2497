# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Route for all topics or services whose names match a pattern; each gets a route of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from rmw_manycore_bridge.counters import (
    NOTHING_LEFT,
    CounterFile,
    Left,
    RouteKey,
    key_of,
    pattern_status_path,
)
from rmw_manycore_bridge.outside.loop import Mover
from rmw_manycore_bridge.sides import Sides
from rmw_manycore_py.ros.patterns import matches
from rmw_manycore_py.routes.plan import Plan
from rmw_manycore_py.routes.route import Route

MAX_NAMES = 4096  # per pattern, as many as a platform has topics; each costs an open file

Types = frozenset[str]


# Returns the types that others than the bridge publish or serve, by wanted name.
Find = Callable[[Callable[[str], bool]], Mapping[str, Types]]


@dataclass
class _Member:
    """A matching topic or service; it has no mover if its route cannot work."""

    types: Types
    slot: int
    sides: Sides
    mover: Mover | None


class Pattern(Mover):
    """Runs in the thread that receives the messages of its topics."""

    def __init__(
        self,
        plan: Plan,
        sides: Sides,
        find: Find,
        make: Callable[[Sides], Mover],
        before: Mapping[RouteKey, Left],  # forwarded by a killed process
    ) -> None:
        super().__init__(sides.fail)
        self._plan, self._sides, self._left = plan, sides, before
        self._find, self._make = find, make
        self._members: dict[str, _Member] = {}
        self._movers: list[Mover] = []  # of the members: visited in every turn
        self._is_full = False
        route = sides.route
        inward = route.direction == "inward"
        self._pattern = route.outside if inward else route.inside
        # Explicit routes take precedence, and of two matching patterns the first.
        single = plan.topics if route.kind == "topic" else plan.services
        beside = [other for other in single(route.direction) if other.domain == route.domain]
        self._taken = {other.outside if inward else other.inside for other in beside}
        patterns = plan.patterns(route.direction)
        earlier = [
            other
            for other in patterns[: patterns.index(route)]
            if (other.domain, other.kind) == (route.domain, route.kind)
        ]
        self._before = [p.outside if inward else p.inside for p in earlier]

    @property
    def due_s(self) -> float:  # type: ignore[override]
        """Earliest deadline of the topics."""
        return min((m.due_s for m in self._movers), default=float("inf"))

    def reconcile(self) -> None:
        """Add new topics, remove those whose type has changed, reconcile the others."""
        found = self._find(self._is_wanted)
        for name, types in found.items():
            member = self._members.get(name)
            if member is not None and member.types != types:
                self._end(name)
            if name not in self._members and self._has_room(found):
                self._members[name] = self._begin(name, types)
        for mover in self._movers:
            mover.try_to_reconcile()
        state = "forwarding" if any(name in found for name in self._members) else "waiting"
        out = len(found.keys() - self._members.keys())
        beyond = f", {out} beyond the {MAX_NAMES} that a pattern bridges" if out else ""
        self._sides.row.set_state(state, f"{self._sides.route.kind}s: {len(found)}{beyond}")

    def expire(self, now_s: float) -> None:
        """Expire the topics that are due."""
        for mover in self._movers:
            if mover.due_s <= now_s:
                mover.expire(now_s)

    def close(self) -> None:
        """Close all topics; keep their counters."""
        for mover in self._movers:
            mover.close()

    def _is_wanted(self, name: str) -> bool:
        if name in self._taken or any(matches(pattern, name) for pattern in self._before):
            return False
        return matches(self._pattern, name)

    def _has_room(self, found: Mapping[str, Types]) -> bool:
        """Return whether there is room; if full, evict a topic without publishers."""
        if len(self._members) < MAX_NAMES:
            return True
        gone = next((name for name in self._members if name not in found), None)
        if gone is not None:
            self._end(gone)
            return True
        if not self._is_full:
            self._is_full = True
            self._sides.report(f"more than {MAX_NAMES} names match; the others are not bridged")
        return False

    def _begin(self, name: str, types: Types) -> _Member:
        slot = self._free_slot()
        sides = self._sides_of(self._route(name, types), slot)
        member = _Member(types, slot, sides, None)
        if len(types) > 1:
            sides.fail(f"has several types, so it is not bridged: {', '.join(sorted(types))}")
            return member
        try:
            member.mover = self._make(sides)
            self._movers.append(member.mover)
        except ImportError as error:
            sides.fail(str(error))
        except Exception as error:  # one failing topic must not stop the others
            sides.fail(f"{type(error).__name__}: {error}")
        return member

    def _end(self, name: str) -> None:
        member = self._members.pop(name)
        if member.mover is not None:
            self._movers.remove(member.mover)
            member.mover.close()
        self._path(member.slot).unlink(missing_ok=True)
        if member.sides.file is not None:
            member.sides.file.close()

    def _route(self, name: str, types: Types) -> Route:
        route = self._sides.route
        if route.direction == "inward":
            names = {"inside": name.removeprefix(route.prefix), "outside": name}
        else:
            names = {"inside": name, "outside": f"{route.prefix}{name}"}
        # The other direction may match the same name; messages are distinguished by publisher gid.
        return replace(route, **names, type=min(types), mirrored=True)  # type: ignore[arg-type]

    def _sides_of(self, route: Route, slot: int) -> Sides:
        file = CounterFile.create(self._path(slot), [route])
        (row,) = file.rows
        row.inherit(self._left.get(key_of(asdict(route)), NOTHING_LEFT))
        return replace(self._sides, route=route, row=row, file=file)

    def _free_slot(self) -> int:
        taken = {member.slot for member in self._members.values()}
        return next(slot for slot in range(len(taken) + 1) if slot not in taken)

    def _path(self, slot: int) -> Path:
        route = self._sides.route
        index = self._plan.patterns(route.direction).index(route)
        stem = self._plan.outside.stem(route.direction)
        return pattern_status_path(self._plan.platform, stem, route.lane, index, slot)
