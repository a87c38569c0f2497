# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""CPUs of a target, and which of them a place may use."""

from __future__ import annotations

from dataclasses import dataclass, field

from simpy import Environment

from rmw_manycore_py.prediction.cpu import Cpu
from rmw_manycore_py.prediction.sites import Site, Sites
from rmw_manycore_py.prediction.target import Target


@dataclass(eq=False)
class TargetCpus:
    """Makes each CPU when a place uses it first."""

    env: Environment
    target: Target
    sites: Sites
    _known: dict[object, Cpu] = field(default_factory=dict)

    def of(self, site: Site) -> tuple[Cpu, ...]:
        """Return the CPUs that a process at this place may use."""
        if self.target.cpus == "cores":
            return (self._cpu(site.core),)
        if self.target.cpus == "own":
            return (self._cpu(object()),)
        if self.target.cpus == "shared":
            return tuple(map(self._cpu, range(round(self.target.cpu_count))))
        named = {cpu for one in self.sites.nodes.values() for cpu in one.host_cpus}
        return tuple(map(self._cpu, sorted(site.host_cpus or named)))

    @property
    def of_host(self) -> dict[int, Cpu]:
        """CPUs of a host by number; none on other targets."""
        if self.target.cpus != "host":
            return {}
        return {number: cpu for number, cpu in self._known.items() if isinstance(number, int)}

    def _cpu(self, key: object) -> Cpu:
        if key not in self._known:
            target = self.target
            self._known[key] = Cpu(self.env, target.ns("slice_us"), target.ns("switch_us"))
        return self._known[key]
