# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Placement for the CallbackIsolatedExecutor."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from rmw_manycore_py.advice.isolated_executor import thread_configuration
from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import FileError
from rmw_manycore_py.mapfile import check
from rmw_manycore_py.profile.files import save
from support.samples.profiles import pipeline

pytestmark = pytest.mark.unit

COMMAND = "command: [sleep, '1'], ros_arguments: false"
SERVICES = (
    "@Service({node}/describe_parameters)@Service({node}/get_parameter_types)"
    "@Service({node}/get_parameters)@Service({node}/list_parameters)"
    "@Service({node}/set_parameters)@Service({node}/set_parameters_atomically)"
)


@pytest.fixture
def mapfile(tmp_path: Path) -> Path:
    path = tmp_path / "map.yaml"
    path.write_text(
        f"nodes:\n  camera: {{cluster: 1, host_cpu: 0, {COMMAND}}}\n"
        f"  filter: {{cluster: 1, {COMMAND}, scheduling: {{policy: fifo, priority: 12}}}}\n"
        f"  sink: {{cluster: 2, {COMMAND}}}\n"
    )
    return path


def groups(text: str) -> dict[str, dict[str, object]]:
    return {one.pop("id"): one for one in yaml.safe_load(text)["callback_groups"]}


def test_each_node_has_its_default_group(mapfile: Path) -> None:
    placement = check(mapfile)
    found = groups(thread_configuration(placement, pipeline()))
    cpus = {node.full_name: [node.host_cpu] for node in placement.nodes}
    camera = f"/camera{SERVICES.format(node='/camera')}"
    filtering = f"/filter{SERVICES.format(node='/filter')}@Subscription(/image)"
    assert found[f"{camera}@Subscription(/parameter_events)@Timer(100000000)"] == {
        "affinity": [0], "policy": "SCHED_OTHER", "priority": 0, "nice": 0,
    }  # fmt: skip
    assert found[f"{filtering}@Subscription(/parameter_events)"] == {
        "affinity": cpus["/filter"], "policy": "SCHED_FIFO", "priority": 12,
    }  # fmt: skip
    assert len(found) == 3


def test_ids_of_a_template_are_kept(mapfile: Path, tmp_path: Path) -> None:
    template = tmp_path / "template.yaml"
    ids = ["/camera@Timer(5)@Waitable", "/filter@Subscription(/image)", "/elsewhere@Timer(1)"]
    rows = [{"id": one, "affinity": None, "policy": "SCHED_OTHER", "priority": 0} for one in ids]
    template.write_text(yaml.safe_dump({"callback_groups": rows}))
    found = groups(thread_configuration(check(mapfile), pipeline(), template))
    assert [*found] == ids[:2]
    template.write_text("callback_groups: [a]\n")
    with pytest.raises(FileError, match="expected callback_groups with ids"):
        thread_configuration(check(mapfile), pipeline(), template)


def test_advise_writes_it(mapfile: Path, tmp_path: Path) -> None:
    profile, out = tmp_path / "app.profile.json", tmp_path / "threads.yaml"
    save(pipeline(), profile)
    words = ["advise", str(mapfile), "--profile", str(profile), "--isolated-executor", str(out)]
    result = CliRunner().invoke(cli, [*words, "--effort", "2", "--duration", "1"])
    assert result.exit_code == 0, result.output
    assert len(groups(out.read_text())) == 3
