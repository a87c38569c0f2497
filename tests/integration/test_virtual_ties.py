# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What is due at one instant comes in one order, in virtual time and in the simulator."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from rmw_manycore_py.bench.virtual_chains import compared_chains
from rmw_manycore_py.profile.files import save
from rmw_manycore_py.trace.files import load
from support import IS_MANYCORE
from support.generated.applications import Application

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

DURATION_S = 1
# Quantiles show what medians hide: messages that another order delays only now and then.
SHARES = (0.1, 0.5, 0.9)
# By seed: nodes, clusters, and cores of each.
SHAPES = {1: (4, 1, 1), 2: (5, 2, 1), 3: (5, 2, 2), 4: (8, 2, 2)}


@pytest.mark.parametrize("seed", SHAPES)
def test_chains_take_the_simulated_time_whatever_is_due_together(
    seed: int, tmp_path: Path, manycore
) -> None:
    nodes, clusters, cores = SHAPES[seed]
    made = Application(seed, nodes=nodes, clusters=clusters, cores=cores)
    names = ("map.yaml", "p.json", "target.yaml", "trace.csv")
    mapfile, file, platform, trace = (tmp_path / name for name in names)
    mapfile.write_text(yaml.safe_dump(made.mapfile()))
    platform.write_text("base: coolidge\nparameters: {speed: {value: 1, source: chosen}}\n")
    profile = made.profile()
    save(profile, file)
    model = ("--profile", file, "--platform", platform)
    manycore("run", mapfile, "--virtual", *model, "--duration", DURATION_S, "--trace", trace)
    chains = [*compared_chains(load(trace), mapfile, profile, str(platform), 0, DURATION_S)]
    assert len(chains) >= 3
    assert {
        (chain.name, share): chain.deviation_at(share) for chain in chains for share in SHARES
    } == pytest.approx({(chain.name, share): 0 for chain in chains for share in SHARES}, abs=0.02)
