# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Tutorials and how-to pages, each followed in an empty directory as a reader would type it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from support import IS_MANYCORE, REPOSITORY, TIMEOUT_S
from support.processes.commands import manycore_command
from support.processes.platforms import environment
from support.sources.doc_commands import script

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="they are about rmw_manycore"),
]

DOCS = REPOSITORY / "docs"
STRICT = "set -euo pipefail\n"
# On a busy machine the nodes of a page may need longer to start than its runs take.
DURATION = "--duration 30"
LONG_S = 10 * TIMEOUT_S

# What the output of each page must contain, in this order.
SHOWN = {
    "tutorials/first_mapfile.md": (
        r"wrong\.yaml:4: nodes\.adder\.core: expected 0 to 15, the cores of cluster 2, found 16",
        r"^exit status 2$",
        r"adder .* makes \d+",
        r"^data: \d+$",
        r"/adder +alive",
        r"/sum",
    ),
    "tutorials/laptop_to_chip.md": (
        r"/sink +alive",
        r"crowded\.yaml.*at most 3\.5 MiB of topic DSMs in cluster 1",
        r"it fits if you move filter to cluster 3",
        r"^exit status 2$",
        r"/image_raw \(/filter\) > /image_inverted",
        r"verdict: it fits, .*; both topics cross clusters, [1-9].* messages/s",
        r"topic_name: /image_raw",
    ),
    "tutorials/offload_ndt.md": (r"ndt_scan_matcher", r"answered", r"/points_raw"),
    "tutorials/which_mapping.md": (
        r"^callbacks +\d+$",
        r"move to another cluster\.",
        r"no mapping keeps all of these limits: ",
        r"^exit status 2$",
        r"between clusters: .*: less$",
    ),
    "tutorials/own_stack.md": (r"recorder", r"average rate", r"Double value is", r"frame_id"),
    "how-to/domain_bridge.md": (r"^data: 'Hello World", r"-> +/chatter"),
    "how-to/ros2_launch.md": (r"listener \| .*I heard",),
    "how-to/troubleshooting.md": (),
    "how-to/where_does_the_time_go.md": (r"communication /camera/image_inverted",),
}
MARKS = {
    "how-to/ros2_launch.md": pytest.mark.long,
    "how-to/where_does_the_time_go.md": pytest.mark.stress,
    "tutorials/first_mapfile.md": pytest.mark.long,
    "tutorials/laptop_to_chip.md": pytest.mark.long,
    "tutorials/offload_ndt.md": pytest.mark.stress,
    "tutorials/own_stack.md": pytest.mark.stress,
    "tutorials/which_mapping.md": pytest.mark.stress,
}
PAGES = [pytest.param(page, marks=MARKS.get(page, ())) for page in sorted(SHOWN)]


@pytest.fixture
def shell(platform: str) -> Iterator[dict[str, str]]:
    """Yield the environment of a shell with .venv active; stop what is left running in it."""
    scripts = Path(sys.executable).parent
    env = environment(platform, PATH=f"{scripts}:{os.environ['PATH']}")
    yield env
    subprocess.run(manycore_command("stop", "--now"), env=env, capture_output=True, check=False)


@pytest.mark.parametrize("page", PAGES)
def test_a_pages_script_runs_as_documented(page, start, shell, tmp_path: Path) -> None:
    typed = re.sub(r"--duration \d+", DURATION, script(DOCS / page))
    command = ["bash", "-c", STRICT + typed]
    reader = start(command, directory=tmp_path, PATH=shell["PATH"])
    assert reader.wait(LONG_S) == 0, reader
    for pattern in SHOWN[page]:
        reader.wait_for(pattern)


def test_every_page_with_a_script_is_here() -> None:
    pages = [*DOCS.glob("tutorials/*.md"), *DOCS.glob("how-to/*.md")]
    assert {str(page.relative_to(DOCS)) for page in pages if script(page)} == set(SHOWN)
