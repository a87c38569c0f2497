# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Counts of profiles of LTTng traces, beside what other programs count in the same traces."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

import pytest

from rmw_manycore_py.profile.caret_files import Architecture, read
from rmw_manycore_py.profile.ros2_tracing import Window, import_trace
from rmw_manycore_py.profile.summary import summary_of
from support.generated.ctf import (
    FROM_TIMER,
    FROM_TOPIC,
    MS,
    begin,
    end,
    node,
    published,
    subscription,
    timer,
    write_trace,
)

pytestmark = [pytest.mark.unit, pytest.mark.needs("babeltrace2")]

# Counts by thread what awk reads in babeltrace2's text, with nothing of this project.
AWK = r"""
function value(key) { match($0, key " = [^,} ]+"); return substr($0, RSTART + length(key) + 3, \
                      RLENGTH - length(key) - 3) }
{ for (i = 1; i <= NF; i++) if ($i ~ /^ros2:/) { n[$i]++; break } }
/ros2:rclcpp_[a-z]*_callback_added:/ { generation[value("vpid") "/" value(" callback")]++ }
/ros2:callback_(start|end):/ {
  split(substr($1, 2), t, "."); thread = value("vpid") "/" value("vtid")
  at = value("vpid") "/" value(" callback")
  now = (t[1] % 1000000) + (substr(t[2], 1, 9) / 1e9)
  if (/callback_start/) {
    if (depth[thread] > 0) around[thread, depth[thread]] = 1
    d = ++depth[thread]; open[thread, d] = at; since[thread, d] = now; around[thread, d] = 0
  } else if ((d = depth[thread]) > 0 && open[thread, d] == at) {
    if (around[thread, d]) enclosing++
    else { runs++; busy += now - since[thread, d]; kinds[at "/" generation[at]] = 1 }
    depth[thread]--
  } else stray++
}
{ split(substr($1, 2), t, "."); last = (t[1] % 1000000) + (substr(t[2], 1, 9) / 1e9)
  if (NR == 1) first = last }
END {
  for (kind in kinds) k++
  for (thread in depth) unfinished += depth[thread]
  printf "{\"executions\": %d, \"callbacks\": %d, \"enclosing\": %d, \"unfinished\": %d, ", \
    runs, k, enclosing, unfinished
  printf "\"begun_before\": %d, \"nodes\": %d, \"publishers\": %d, \"subscriptions\": %d, ", \
    stray, n["ros2:rcl_node_init:"], n["ros2:rcl_publisher_init:"], \
    n["ros2:rcl_subscription_init:"]
  printf "\"publications\": %d, \"begins\": %d, \"ends\": %d, \"duration_s\": %.6f, ", \
    n["ros2:rcl_publish:"], n["ros2:callback_start:"], n["ros2:callback_end:"], last - first
  printf "\"cpus_busy\": %.6f}\n", busy / (last - first)
}
"""


def counted_by_awk(trace: Path) -> dict[str, float]:
    text = subprocess.Popen(
        ["babeltrace2", "--clock-seconds", "--no-delta", str(trace)], stdout=subprocess.PIPE
    )
    with text:
        found = subprocess.run(["awk", AWK], stdin=text.stdout, check=True, stdout=subprocess.PIPE)
    assert text.returncode == 0
    counts = json.loads(found.stdout)
    assert isinstance(counts, dict)
    return counts


def check_counts(trace: Path) -> dict[str, float]:
    """Compare the profile with the independent counts; return its summary."""
    summary = summary_of(import_trace(trace, Window()))
    counts = counted_by_awk(trace)
    accounted = summary["executions"] + summary["enclosing"]
    assert accounted + summary["unfinished"] == counts.pop("begins")
    assert accounted + summary["begun_before"] == counts.pop("ends")
    for key, value in counts.items():
        assert summary[key] == pytest.approx(value, abs=2e-5), key
    return summary


def test_the_counts_are_those_of_awk(tmp_path) -> None:
    events = [*node(1, "a"), *subscription(1, "/in"), *timer(1), *node(2, "b"), *timer(2)]
    for at_ms in range(10, 400, 7):
        pid = 1 + at_ms % 2
        events += [begin(at_ms, pid, pid, FROM_TIMER), published(at_ms + 1, pid, pid)]
        events += [end(at_ms + 3, pid, pid, FROM_TIMER)]
    events += [end(410, 1, 1, FROM_TOPIC), begin(411, 1, 1, FROM_TIMER)]
    events += [begin(412, 1, 1, FROM_TOPIC), end(413, 1, 1, FROM_TOPIC), end(414, 1, 1, FROM_TIMER)]
    events += [*subscription(1, "/in", at_ns=415 * MS), begin(416, 1, 1, FROM_TOPIC)]
    events += [end(417, 1, 1, FROM_TOPIC), begin(418, 2, 2, FROM_TIMER)]
    summary = check_counts(write_trace(tmp_path / "trace", events))
    assert (summary["callbacks"], summary["enclosing"], summary["unfinished"]) == (4, 1, 1)


# The data set's directory; see the test for what it holds.
AUTOWARE = os.environ.get("MANYCORE_TEST_AUTOWARE")
EXPECTED = {
    "aw_replay": {
        "nodes": 226, "subscriptions": 787, "publishers": 736, "callbacks": 786,
        "executions": 903_206, "enclosing": 1, "publications": 52_133,
    },
    "aw_carla": {
        "nodes": 195, "subscriptions": 704, "publishers": 570, "callbacks": 341,
        "executions": 302_859, "enclosing": 1, "publications": 27_908,
    },
    "aw_scenario": {
        "nodes": 160, "subscriptions": 470, "publishers": 579, "callbacks": 431,
        "executions": 799_061, "enclosing": 1, "publications": 189_246,
    },
}  # fmt: skip


@pytest.mark.long
@pytest.mark.skipif(not AUTOWARE, reason="MANYCORE_TEST_AUTOWARE names no directory of traces")
@pytest.mark.parametrize("name", EXPECTED)
def test_the_counts_of_autoware_are_those_of_awk(name: str, tmp_path) -> None:
    """Of aw_*.tar.xz: traces of github.com/TUM-AVS/ros2_latency_analysis, commit 3751b4f."""
    assert AUTOWARE is not None
    archive = Path(AUTOWARE) / f"{name}.tar.xz"
    subprocess.run(["tar", "xf", archive, "-C", tmp_path], check=True)
    summary = check_counts(tmp_path)
    assert {key: summary[key] for key in EXPECTED[name]} == EXPECTED[name]


@pytest.mark.long
@pytest.mark.skipif(not AUTOWARE, reason="MANYCORE_TEST_AUTOWARE names no directory of traces")
def test_a_trace_of_caret_is_read_as_caret_reads_it(tmp_path: Path) -> None:
    """Of caret_sample.tar.xz: the sample of github.com/tier4/caret_demos with its architecture."""
    assert AUTOWARE is not None
    archive = Path(AUTOWARE) / "caret_sample.tar.xz"
    subprocess.run(["tar", "xf", archive, "-C", tmp_path], check=True)
    check_counts(tmp_path)
    profile = import_trace(tmp_path, Window())
    architecture = read(next(tmp_path.rglob("architecture.yaml")), Architecture)
    theirs = {
        (their.node_name, one.topic_name, one.period_ns, one.symbol)
        for their in architecture.nodes
        for one in their.callbacks
    }
    ours = {
        (profile.nodes[one.node].name, one.trigger, one.period_ns, one.symbol): one
        for one in profile.callbacks
        if one.node is not None
    }
    assert theirs <= set(ours)
    kinds = {
        group.callback_group_type for their in architecture.nodes for group in their.callback_groups
    }
    assert {group.kind for group in profile.groups} == kinds
    assert [one.kind for one in profile.executors] == [
        one.executor_type for one in architecture.executors
    ]
    causes = {
        (profile.publishers[output.publisher].topic, *key)
        for key, callback in ours.items()
        for output in callback.publishes
    }
    for their in architecture.nodes:
        for publish in their.publishes:
            for one in their.callbacks:
                if one.callback_name in publish.callback_names:
                    key = (their.node_name, one.topic_name, one.period_ns, one.symbol)
                    assert (publish.topic_name, *key) in causes
