# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A loaded mapfile."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from rmw_manycore_py.mapfile.format.document import Document
from rmw_manycore_py.mapfile.format.model import MapfileSections, NodeSection
from rmw_manycore_py.platform.topology import Topology
from rmw_manycore_py.ros.domain import default_platform


@dataclass(frozen=True)
class Mapfile:
    """A mapfile that is valid in itself; `resolve` checks whether its executables exist.

    :param path: the file.
    :param sections: its contents, section by section.
    :param topology: clusters and cores of the platform that it describes.
    :param document: where in the file each key stands, for errors.
    :param notices: what the user should know, although nothing is wrong.
    :param host: the host whose part it is; None for the whole.
    """

    path: Path
    sections: MapfileSections
    topology: Topology
    document: Document
    notices: tuple[str, ...]
    host: str | None = None

    @property
    def platform_name(self) -> str:
        """Name of the platform; default: the platform of nodes started by hand."""
        return self.sections.platform.name or default_platform()

    def with_nodes(self, nodes: Mapping[str, NodeSection]) -> Mapfile:
        """Return the mapfile with other nodes."""
        return replace(self, sections=self.sections.model_copy(update={"nodes": dict(nodes)}))

    def only(self, names: Collection[str]) -> Mapfile:
        """Return the mapfile with some of its nodes."""
        chosen = {name: node for name, node in self.sections.nodes.items() if name in names}
        return self.with_nodes(chosen)

    def of_host(self, name: str) -> Mapfile:
        """Return the part of a host: the nodes of its clusters."""
        clusters = self.sections.hosts[name].clusters
        nodes = self.sections.nodes.items()
        return replace(
            self.with_nodes({node: one for node, one in nodes if one.cluster in clusters}),
            host=name,
        )

    @property
    def own_clusters(self) -> tuple[int, ...] | None:
        """Clusters of this host; None for the whole mapfile, which has all."""
        return self.sections.hosts[self.host].clusters if self.host else None

    @property
    def home_cluster(self) -> int:
        """Cluster of the bridge and of the links: the first of this host."""
        return self.own_clusters[0] if self.own_clusters else 1

    def file(self, name: str) -> Path:
        """Return the path of a referenced file: relative to the mapfile, `~` expanded."""
        return Path(os.path.realpath(self.path.parent / os.path.expanduser(name)))
