# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Profiles of CARET's reports."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest
import yaml

from rmw_manycore_py.errors import FileError, ManycoreError
from rmw_manycore_py.profile.importing import import_source
from rmw_manycore_py.profile.model import Profile
from rmw_manycore_py.profile.ros2_tracing import Window
from rmw_manycore_py.profile.summary import summary_of

pytestmark = pytest.mark.unit

CHAIN = """\
- path_name: drive
  node_chain:
  - {node_name: /camera, publish_topic_name: /image, subscribe_topic_name: UNDEFINED}
  - {node_name: /filter, publish_topic_name: UNDEFINED, subscribe_topic_name: /image}
"""
ARCHITECTURE = """\
named_paths: []
executors:
- executor_type: single_threaded_executor
  executor_name: executor_0
  callback_group_names: []
- executor_type: multi_threaded_executor
  executor_name: executor_1
  callback_group_names: [/filter/callback_group_0]
nodes:
- node_name: /camera
  callbacks:
  - {callback_name: /camera/callback_0, callback_type: timer_callback, period_ns: 50000000,
     symbol: "Camera::shoot()"}
  publishes:
  - {topic_name: /image, callback_names: [/camera/callback_0]}
  - {topic_name: /image, callback_names: [UNDEFINED]}
- node_name: /filter
  callback_groups:
  - callback_group_type: mutually_exclusive
    callback_group_name: /filter/callback_group_0
    callback_names: [/filter/callback_0]
  callbacks:
  - {callback_name: /filter/callback_0, callback_type: subscription_callback, topic_name: /image}
  - {callback_name: /filter/callback_1, callback_type: subscription_callback, topic_name: /never}
  subscribes:
  - {topic_name: /image, callback_name: /filter/callback_0}
  - {topic_name: /never, callback_name: /filter/callback_1}
"""
NONE = dict.fromkeys(("avg", "std", "min", "max", "p50", "p95", "p99"), "---")
KEYS = ("min", "p50", "avg", "p95", "p99", "max")


def statistics(latency_ms: object, period_ms: object, frequency_hz: object) -> dict[str, object]:
    return {"Latency": latency_ms, "Period": period_ms, "Frequency": frequency_hz}


def write_report(directory: Path) -> Path:
    """Write a report of a camera, a filter, and a callback that never ran."""
    latency = dict(zip(KEYS, (1.0, 2.0, 2.5, 4.0, 4.5, 5.0), strict=True))
    period = dict(zip(KEYS, (90.0, 99.0, 100.0, 101.0, 109.0, 110.0), strict=True))
    once = dict(zip(KEYS, (0.5,) * 6, strict=True))
    ran = statistics(latency, period, once)
    nodes = {
        "filter": {"/filter/callback_0": ran, "/filter/callback_1": statistics(NONE, NONE, NONE)},
        "camera": {"/camera/callback_0": statistics(once, NONE, once)},
    }
    for name, callbacks in nodes.items():
        (directory / name).mkdir(parents=True)
        content = {f"/{name}": {"callbacks": callbacks}}
        (directory / name / "stats_node.yaml").write_text(yaml.safe_dump(content))
    (directory / "architecture.yaml").write_text(ARCHITECTURE)
    with_chain = ARCHITECTURE.replace("named_paths: []\n", f"named_paths:\n{CHAIN}")
    (directory / "architecture_path.yaml").write_text(with_chain)
    return directory


def imported(directory: Path) -> Profile:
    return import_source(directory, Window())


def test_a_report_holds_callbacks_with_their_statistics(tmp_path: Path) -> None:
    profile = imported(write_report(tmp_path / "report"))
    assert [node.name for node in profile.nodes] == ["/camera", "/filter"]
    camera, filtering, never = profile.callbacks
    assert (camera.kind, camera.period_ns, camera.symbol) == (
        "timer",
        50_000_000,
        "Camera::shoot()",
    )
    assert camera.rate_hz == 0.5
    assert camera.interval_ns is None
    (output,) = camera.publishes
    assert (output.publisher, output.count) == (0, None)
    assert (filtering.trigger, filtering.subscription, filtering.rate_hz) == ("/image", 0, 10.0)
    assert filtering.wall_ns is not None
    assert filtering.wall_ns.mean == 2_500_000
    assert filtering.wall_ns.quantiles == (1e6, 2e6, 4e6, 4.5e6, 5e6)
    assert profile.quantile_shares == (0.0, 0.5, 0.95, 0.99, 1.0)
    assert (never.rate_hz, never.wall_ns) == (None, None)
    summary = summary_of(profile)
    assert (summary["callbacks"], summary["executions"], summary["publishers"]) == (2, None, 2)
    assert summary["cpus_busy"] == pytest.approx(0.5 * 0.5e-3 + 10 * 2.5e-3)


def test_groups_executors_and_chains_are_those_of_the_architecture(tmp_path: Path) -> None:
    profile = imported(write_report(tmp_path / "report"))
    assert [one.group for one in profile.callbacks] == [None, 0, None]
    assert (profile.groups[0].kind, profile.groups[0].executor) == ("mutually_exclusive", 0)
    assert [one.name for one in profile.executors] == ["executor_1"]
    (chain,) = profile.chains
    assert [(hop.node, hop.subscribes, hop.publishes) for hop in chain.hops] == [
        (0, None, "/image"),
        (1, "/image", None),
    ]


def test_latencies_of_chains_are_not_read(tmp_path: Path) -> None:
    report = write_report(tmp_path / "report")
    (report / "stats_path.yaml").write_text("{ no YAML")
    assert imported(report).chains


@pytest.mark.parametrize(
    ("file", "text", "error"),
    [
        ("architecture.yaml", "{ no YAML", r"architecture\.yaml: expected a file that CARET"),
        ("architecture.yaml", "[]", "expected a file that CARET writes, found Input should be"),
        ("architecture.yaml", "nodes: [{}]", r"nodes\.0\.node_name: .* found Field required"),
        ("filter/stats_node.yaml", "/filter: {callbacks: {/x: 3}}", r"callbacks\./x: expected"),
    ],
)
def test_a_damaged_file_is_named(tmp_path: Path, file: str, text: str, error: str) -> None:
    report = write_report(tmp_path / "report")
    (report / file).write_text(text)
    with pytest.raises(FileError, match=error):
        imported(report)


def test_statistics_of_another_architecture_are_refused(tmp_path: Path) -> None:
    report = write_report(tmp_path / "report")
    for path in report.glob("architecture*.yaml"):
        path.write_text(path.read_text().replace("/camera/callback_0", "/camera/callback_9"))
    with pytest.raises(FileError, match=r"expected the callback /camera/callback_0, found none"):
        imported(report)


def test_other_directories_and_windows_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileError, match=r"expected an LTTng trace .* found neither"):
        imported(tmp_path)
    with pytest.raises(ManycoreError, match="--begin and --end do not apply"):
        import_source(write_report(tmp_path / "report"), Window(1, 2))


def test_an_architecture_without_statistics_is_refused(tmp_path: Path) -> None:
    report = write_report(tmp_path / "report")
    for path in report.rglob("stats_node.yaml"):
        path.unlink()
    with pytest.raises(FileError, match=r"expected statistics of callbacks .* found none"):
        imported(report)


AUTOWARE = os.environ.get("MANYCORE_TEST_AUTOWARE")


@pytest.mark.long
@pytest.mark.skipif(not AUTOWARE, reason="MANYCORE_TEST_AUTOWARE names no directory of reports")
def test_the_counts_of_a_published_report_are_those_of_grep(tmp_path: Path) -> None:
    """Of caret_report.tar.xz: the report of github.com/tier4/caret_report of 2022-12-27."""
    assert AUTOWARE is not None
    archive = Path(AUTOWARE) / "caret_report.tar.xz"
    subprocess.run(["tar", "xf", archive, "-C", tmp_path], check=True)
    architecture = next(tmp_path.rglob("architecture_path.yaml"))

    def lines(pattern: str, *paths: Path) -> int:
        command = ["grep", "-hcE", pattern, *paths]
        found = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
        return sum(map(int, found.stdout.split()))

    profile = imported(tmp_path)
    summary = summary_of(profile)
    assert summary["nodes"] == lines("^- node_name:", architecture) == 131
    assert len(profile.callbacks) == lines("^  - callback_name:", architecture) == 282
    assert summary["chains"] == lines("^- path_name:", architecture) == 7
    statistics_files = list(tmp_path.rglob("stats_node.yaml"))
    assert lines("callback_legend:", *statistics_files) == 251
    without = lines("avg: '?---'?", *statistics_files) / 3  # of frequency, period, latency
    assert summary["callbacks"] == 251 - without == 206
    assert summary["cpus_busy"] == pytest.approx(3.6435, abs=1e-4)
