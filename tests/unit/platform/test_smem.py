# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The memory model has the sizes of the transport's headers."""

from __future__ import annotations

import re

import pytest

from rmw_manycore_py.platform import smem
from rmw_manycore_py.platform.smem import Smem
from support import REPOSITORY

pytestmark = pytest.mark.unit

TRANSPORT = REPOSITORY / "rmw_manycore/transport"
KIB, MIB = 1 << 10, 1 << 20
MIRRORED = {
    "CLUSTER_HEADER": "ClusterHeader",
    "TOPIC_DSM_HEADER": "TopicDsmHeader",
    "LANDING_TABLE": "LandingTable",
    "LANDING_HEADER": "LandingHeader",
    "DESCRIPTOR": "RecordDescriptor",
    "SUBSCRIPTION_HEADER": "SubscriptionHeader",
    "RECORD_ALIGNMENT": "record_alignment",
    "FIRST_DESCRIPTORS": "first_descriptor_count",
    "FIRST_DATA": "first_data_bytes",
}


def sizes_in_headers() -> dict[str, int]:
    """Return asserted sizes of structs, and constants."""
    headers = [*(TRANSPORT / "layout").glob("*.hpp"), TRANSPORT / "topic_dsm/generation.hpp"]
    text = "\n".join(header.read_text() for header in headers)
    sizes = re.findall(r"static_assert\(sizeof\((\w+)\) == (\d+)\b", text)
    constants = re.findall(r"^constexpr uint64_t (\w+) = (\d+);", text, re.MULTILINE)
    return {name: int(value) for name, value in (*sizes, *constants)}


def test_sizes_are_those_of_the_headers() -> None:
    found = sizes_in_headers()
    assert {name: getattr(smem, name) for name in MIRRORED} == {
        name: found[size] for name, size in MIRRORED.items()
    }
    assert found["granule_map_offset"] == smem.CLUSTER_HEADER


def test_granules_are_those_of_a_cluster() -> None:
    text = (TRANSPORT / "registry/cluster.cpp").read_text()
    found = re.search(r"smem_bytes <= \((\d+)u << 20\) \? (\d+) : page_bytes", text)
    assert found
    limit_mib, granule = map(int, found.groups())
    assert (limit_mib * MIB, granule) == (smem.SMALL_SMEM, smem.SMALL_GRANULE)


def test_a_node_takes_what_the_docs_say() -> None:
    page = (REPOSITORY / "docs/reference/cli/looking.md").read_text()
    words = re.search(r"\*nodes\*, (\d+)\s+KiB each \((\d+) KiB with more than (\d+) MiB", page)
    assert words
    small, large, limit_mib = map(int, words.groups())
    assert Smem(limit_mib * MIB).node == small * KIB
    assert Smem(limit_mib * MIB + 1).node == large * KIB
