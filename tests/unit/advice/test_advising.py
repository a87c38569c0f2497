# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Advised mapfiles: they pass `map check`, keep wishes, and say what was done."""

from __future__ import annotations

import json
import os
import random
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT
from rmw_manycore_py.mapfile import Placement, check
from rmw_manycore_py.profile.files import save
from rmw_manycore_py.profile.model import Node, Process, Profile, Subscription
from support.samples.profiles import callback, pipeline, publishes, steady

pytestmark = pytest.mark.unit

COMMAND = "command: [sleep, '1'], ros_arguments: false"
QUICK = ("--effort", "2", "--duration", "1", "--candidates", "4")


def drawn(seed: int, count: int) -> Profile:
    """Return nodes in a random graph: each publishes when it has received."""
    chance = random.Random(seed)
    sample = pipeline()
    sources = {i: chance.sample(range(i), min(i, chance.randint(1, 2))) for i in range(1, count)}
    subscriptions = [
        Subscription(node=node, topic=f"/t{source}", queue_depth=4)
        for node, own in sources.items()
        for source in own
    ]
    callbacks = [
        callback(0, 1, kind="timer", period_ns=100_000_000, publishes=publishes(0, 1)),
        *(
            callback(
                one.node, chance.uniform(1, 5), trigger=one.topic, subscription=i,
                publishes=publishes(one.node, 1),
            )
            for i, one in enumerate(subscriptions)
        ),
    ]  # fmt: skip
    return pipeline(
        processes=tuple(Process(name=f"n{i}", threads=1) for i in range(count)),
        nodes=tuple(Node(name=f"/n{i}", process=i) for i in range(count)),
        publishers=tuple(
            sample.publishers[0].model_copy(
                update={"node": i, "topic": f"/t{i}", "size_bytes": steady(100 * (i + 1))}
            )
            for i in range(count)
        ),
        subscriptions=tuple(subscriptions),
        callbacks=tuple(callbacks),
    )


def written(directory: Path, profile: Profile, text: str) -> tuple[Path, Path]:
    """Write mapfile and profile."""
    mapfile, file = directory / "map.yaml", directory / "app.profile.json"
    mapfile.write_text(text)
    save(profile, file)
    return mapfile, file


def spread(profile: Profile, head: str, clusters: int) -> str:
    """Return a mapfile with neighbours in different clusters."""
    lines = [
        f"  {one.name[1:]}: {{cluster: {i % clusters + 1}, {COMMAND}}}  # number {i}\n"
        for i, one in enumerate(profile.nodes)
    ]
    return f"# A test.\n{head}\nnodes:\n{''.join(lines)}"


def advise(mapfile: Path, profile: Path, *words: str) -> Result:
    out = str(mapfile.parent / "advised.yaml")
    arguments = ("advise", str(mapfile), "--profile", str(profile), "-o", out, *QUICK, *words)
    return CliRunner().invoke(cli, arguments)


def places(placement: Placement) -> dict[str, int]:
    return {node.name: node.cluster for node in placement.nodes}


@pytest.mark.parametrize("seed", range(4))
def test_advice_passes_check_and_keeps_wishes(tmp_path: Path, seed: int) -> None:
    profile = drawn(seed, 8 + seed)
    platform = "{profile: coolidge, clusters: 4, cores_per_cluster: 6}"
    mapfile, file = written(tmp_path, profile, spread(profile, f"platform: {platform}", 4))
    wishes = ("--fix", "n3", "--apart", "n1,n2", "--together", "n0,n4")
    result = advise(mapfile, file, *wishes, "--json")
    assert result.exit_code == 0, result.output
    data = json.loads(result.stdout)
    after = places(check(tmp_path / "advised.yaml"))
    before = places(check(mapfile))
    assert {name: one for name, one in after.items() if before[name] != one} == data["moves"]
    assert after["n3"] == before["n3"]
    assert after["n1"] != after["n2"]
    assert after["n0"] == after["n4"]
    scores = [one["score"] for one in data["candidates"]]
    assert scores == sorted(scores)
    text = (tmp_path / "advised.yaml").read_text()
    assert all(f"# number {i}" in text for i in range(len(profile.nodes)))
    assert text.startswith("# A test.\n")


def test_fewest_bytes_of_a_pipeline_in_one_cluster(tmp_path: Path) -> None:
    profile = pipeline()
    mapfile, file = written(tmp_path, profile, spread(profile, "platform: coolidge", 3))
    result = advise(mapfile, file, "--objective", "bytes")
    assert result.exit_code == 0, result.output
    assert len(set(places(check(tmp_path / "advised.yaml")).values())) == 1
    assert "Between clusters: 20.0 messages/s and 19.53 KiB/s before, 0.0 messages/s" in (
        result.output
    )
    assert "beside filter (10.0 messages/s)" in result.output


def test_a_mapfile_without_room_is_repaired(tmp_path: Path) -> None:
    """Twelve nodes in a cluster of four cores, three of them free."""
    profile = drawn(1, 12)
    platform = "platform: {profile: coolidge, clusters: 4, cores_per_cluster: 5}"
    mapfile, file = written(tmp_path, profile, spread(profile, platform, 1))
    result = advise(mapfile, file)
    assert result.exit_code == 0, result.output
    assert set(places(check(tmp_path / "advised.yaml")).values()) == {1, 2, 3, 4}
    assert "All 3 free cores of cluster 1 are taken." in result.output


def test_nodes_share_cores_evenly(tmp_path: Path) -> None:
    profile = drawn(2, 10)
    head = "platform: {profile: coolidge, clusters: 2, cores_per_cluster: 4}"
    head += "\nallow_shared_cores: true"
    lines = [f"  n{i}: {{cluster: 1, core: 1, {COMMAND}}}\n" for i in range(10)]
    mapfile, file = written(tmp_path, profile, f"{head}\nnodes:\n{''.join(lines)}")
    result = advise(mapfile, file, "--objective", "load")
    assert result.exit_code == 0, result.output
    cores = [node.place for node in check(tmp_path / "advised.yaml").nodes]
    assert len(set(cores)) == 6  # all but the reserved ones


def test_host_cpus_are_loaded_evenly(tmp_path: Path) -> None:
    """Six equal nodes in clusters of their own, all on one host CPU: no core is busier."""
    cpus = sorted(os.sched_getaffinity(0))
    if len(cpus) < 2:
        pytest.skip("there is one CPU")
    profile = drawn(2, 6)
    place = f"host_cpu: {cpus[0]}, {COMMAND}"
    lines = [f"  n{i}: {{cluster: {1 + i % 3}, {place}}}\n" for i in range(6)]
    mapfile, file = written(tmp_path, profile, f"platform: host\nnodes:\n{''.join(lines)}")
    result = advise(mapfile, file, "--objective", "load", "--json")
    assert result.exit_code == 0, result.output
    scores = {one["name"]: one["score"] for one in json.loads(result.stdout)["candidates"]}
    assert min(scores.values()) < 0.8 * scores["as it is"]
    assert len({node.host_cpu for node in check(tmp_path / "advised.yaml").nodes}) > 1


def test_a_chain_on_a_host_has_priorities(tmp_path: Path) -> None:
    profile = pipeline()
    mapfile, file = written(tmp_path, profile, spread(profile, "platform: host", 3))
    chain = ("--chain", "/image /small")
    result = advise(mapfile, file, *chain, "--json")
    assert result.exit_code == 0, result.output
    names = {one["name"] for one in json.loads(result.stdout)["candidates"]}
    assert any(name.endswith(", in real time") for name in names)
    now = next(o for o in json.loads(result.stdout)["candidates"] if o["name"] == "as it is")
    assert now["messages_per_s"] == pytest.approx(20)  # the chain counts once
    result = advise(mapfile, file, *chain, "--no-priorities", "--json")
    names = {one["name"] for one in json.loads(result.stdout)["candidates"]}
    assert not any(name.endswith(", in real time") for name in names)


def test_what_cannot_be_is_explained(tmp_path: Path) -> None:
    profile = drawn(3, 8)
    head = "platform: {profile: coolidge, clusters: 2, cores_per_cluster: 5}"
    mapfile, file = written(tmp_path, profile, spread(profile, head, 2))
    result = advise(mapfile, file)
    assert result.exit_code == EXIT_BAD_INPUT
    assert "no mapping is feasible: cores (8 are needed, 6 are free in 2 clusters)" in result.output
    assert "it fits with allow_shared_cores: true\nor with cores_per_cluster: 6" in result.output
    assert not (tmp_path / "advised.yaml").exists()


def test_too_little_memory_is_explained(tmp_path: Path) -> None:
    profile = drawn(3, 8)
    head = "platform: {profile: coolidge, clusters: 2, smem_size: 256KiB}"
    mapfile, file = written(tmp_path, profile, spread(profile, head, 2))
    result = advise(mapfile, file)
    assert "no mapping is feasible: memory (8 nodes take" in result.output
    assert "it fits with smem_size: 1MiB" in result.output


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("--fix", "nobody"), "--fix: no node 'nobody'; the mapfile has camera, filter and sink"),
        (("--apart", "camera"), "--apart camera: expected at least 2 nodes, found one"),
        (("--chain", "/image /none"), "--chain: no topic '/none' in mapfile and profile"),
    ],
)
def test_wrong_wishes_are_refused(tmp_path: Path, words: tuple[str, ...], text: str) -> None:
    profile = pipeline()
    result = advise(*written(tmp_path, profile, spread(profile, "platform: coolidge", 1)), *words)
    assert (result.exit_code, text in result.output) == (EXIT_BAD_INPUT, True), result.output


def test_a_profile_of_another_application_is_refused(tmp_path: Path) -> None:
    text = spread(pipeline(), "platform: coolidge", 1)
    result = advise(*written(tmp_path, drawn(0, 3), text))
    assert result.exit_code == EXIT_BAD_INPUT
    assert "the profile is of another application: expected /camera, /filter and /sink" in (
        result.output
    )


def test_a_plan_from_a_profile_alone(tmp_path: Path) -> None:
    profile = drawn(4, 9)
    save(profile, tmp_path / "app.profile.json")
    source, plan = str(tmp_path / "app.profile.json"), str(tmp_path / "plan.yaml")
    result = CliRunner().invoke(cli, ["map", "init", source, "--profile", "coolidge", "-o", plan])
    assert result.exit_code == 0, result.output
    result = advise(Path(plan), Path(source))
    assert result.exit_code == 0, result.output
    assert len(check(tmp_path / "advised.yaml").nodes) == 9
