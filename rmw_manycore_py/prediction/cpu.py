# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""CPUs with the scheduling policies of sched(7).

A task runs until it has had its demand. Real-time tasks preempt all of lower priority, and `other`
tasks. Those share a CPU by virtual time, as Linux does: the task that has run least runs next, and
keeps the CPU for a slice, even if another wakes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from simpy import Environment
from simpy.events import Timeout

from rmw_manycore_py.process.scheduling import REAL_TIME, Scheduling

_ROUNDING_NS = 0.5
_RR_SLICE_NS = 100e6  # sched_rr_timeslice_ms of Linux
_NEVER_NS = float("inf")


@dataclass(eq=False)
class Task:
    """A thread as its CPUs see it.

    :ivar rank: 0 for `other` tasks, else the real-time priority.
    :ivar used_ns: CPU time so far.
    """

    cpus: Sequence[Cpu]
    rank: int = 0
    slice_ns: float | None = None  # of `rr`; None: that of its CPU, and of `fifo` none
    used_ns: float = 0.0
    virtual_ns: float = 0.0
    left_ns: float = 0.0
    then: Callable[[], None] | None = None
    cpu: Cpu | None = None
    home: Cpu | None = None  # the last one

    @classmethod
    def of(cls, cpus: Sequence[Cpu], scheduling: Scheduling | None) -> Task:
        """Return a task with a policy of sched(7)."""
        if scheduling is None or scheduling.policy not in REAL_TIME:
            return cls(cpus)
        return cls(
            cpus, scheduling.priority, _RR_SLICE_NS if scheduling.policy == "rr" else _NEVER_NS
        )

    @property
    def has_idle_cpu(self) -> bool:
        """Whether it would run at once."""
        return any(cpu.current is None for cpu in self.cpus)

    @property
    def is_demanding(self) -> bool:
        """Whether it has not had its demand."""
        return self.then is not None

    def run(self, demand_ns: float, then: Callable[[], None]) -> None:
        """Call `then` when this task has had more CPU time; it keeps its CPU if it asks in then."""
        self.left_ns, self.then = demand_ns, then
        if self.cpu is None:
            self.cpu = self._chosen()
            self.cpu.add(self)

    def _chosen(self) -> Cpu:
        if len(self.cpus) == 1:
            return self.cpus[0]
        if self.home is not None and self.home.current is None:
            return self.home
        return min(self.cpus, key=Cpu.busyness)


@dataclass(eq=False)
class Cpu:
    """One CPU.

    :ivar current: the task that runs.
    :ivar used_ns: time that it gave to tasks so far.
    """

    env: Environment
    slice_ns: float
    switch_ns: float
    current: Task | None = None
    used_ns: float = 0.0
    waiting: list[Task] = field(default_factory=list)
    _since_ns: float = 0.0  # of `current`: its CPU time before is counted
    _slice_end_ns: float = 0.0
    _plan: object = None  # the timeout that counts; earlier ones are void
    _last: Task | None = None
    _virtual_ns: float = 0.0
    _is_between: bool = False  # demands of `current`

    def busyness(self) -> int:
        """Return the number of tasks that want this CPU."""
        return len(self.waiting) + (self.current is not None)

    def add(self, task: Task) -> None:
        """Take a task that has become runnable."""
        if task.home is not self:
            task.home, task.virtual_ns = self, self._virtual_ns
        task.virtual_ns = max(task.virtual_ns, self._virtual_ns - self.slice_ns)
        if self.current is None:
            self._start(task)
            return
        self.waiting.append(task)
        if not self._is_between:
            self._account()
            self._go_on()

    def _account(self) -> None:
        """Count the CPU time of the current task."""
        current, now = self.current, self.env.now
        assert current is not None
        ran_ns = now - self._since_ns
        current.used_ns += ran_ns
        self.used_ns += ran_ns
        current.left_ns -= ran_ns
        current.virtual_ns += ran_ns
        self._since_ns = now

    def _start(self, task: Task) -> None:
        now = self.env.now
        self.current = task
        self._virtual_ns = max(self._virtual_ns, task.virtual_ns)
        self._since_ns = now
        self._slice_end_ns = now + self._slice_of(task)
        if task is not self._last:
            task.left_ns += self.switch_ns
            self._last = task
        self._go_on()

    def _go_on(self) -> None:
        """Decide which task runs on."""
        current = self.current
        assert current is not None
        if not self.waiting:
            self._schedule(is_shared=False)
            return
        rank = max([one.rank for one in self.waiting])
        is_over = self.env.now >= self._slice_end_ns - _ROUNDING_NS
        if rank > current.rank:
            self._switch()
        elif rank == current.rank and is_over:
            self._slice_end_ns = self.env.now + self._slice_of(current)
            self._switch()
        else:
            self._schedule(is_shared=rank == current.rank)

    def _slice_of(self, task: Task) -> float:
        return self.slice_ns if task.slice_ns is None else task.slice_ns

    def _schedule(self, *, is_shared: bool) -> None:
        """Plan the end of the current task's demand, or of its slice if others want the CPU."""
        current = self.current
        assert current is not None
        delay_ns = max(current.left_ns, 0.0)
        if is_shared:
            delay_ns = min(delay_ns, self._slice_end_ns - self.env.now)
        plan = Timeout(self.env, delay_ns)
        self._plan = plan
        callbacks: Any = plan.callbacks
        callbacks.append(self._at_end)

    def _at_end(self, plan: object) -> None:
        if plan is not self._plan:
            return
        self._account()
        current = self.current
        assert current is not None
        if current.left_ns > _ROUNDING_NS:
            self._go_on()
            return
        then, current.then = current.then, None
        assert then is not None
        self._is_between = True
        then()
        self._is_between = False
        if current.is_demanding:  # it keeps the CPU
            self._go_on()
            return
        current.cpu = None
        self._next()

    def _switch(self) -> None:
        """Have the most eligible task run."""
        assert self.current is not None
        self.waiting.append(self.current)
        self._next()

    def _next(self) -> None:
        if not self.waiting:
            self.current = None
            self._plan = None
            return
        task = min(self.waiting, key=_order) if len(self.waiting) > 1 else self.waiting[0]
        self.waiting.remove(task)
        if task is self.current:
            self._go_on()
        else:
            self._start(task)


def _order(task: Task) -> tuple[int, float]:
    """Return a sort key: real-time tasks of a priority are in order of coming, others are not."""
    return -task.rank, 0.0 if task.rank else task.virtual_ns
