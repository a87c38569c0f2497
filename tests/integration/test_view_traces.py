# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore view --file`: traces of a real and of a simulated run."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from rmw_manycore_py.prediction import predict
from rmw_manycore_py.prediction.target_file import TARGETS
from rmw_manycore_py.trace.files import save
from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.samples.profiles import pipeline, sites

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("simulated") / "simulated.json"
    found = predict(sites(1, 2, 3), pipeline(), TARGETS["host"], duration_s=4, is_traced=True)
    assert found.trace is not None
    save(found.trace, path)
    return path


@pytest.fixture
def measured(start, tmp_path: Path) -> Path:
    path = tmp_path / "measured.csv"
    run = start(forked_manycore("run", "talker_listener", "--trace", path))
    for _ in range(3):
        run.wait_for("I heard")
    assert run.stop() == 0, run
    return path


def test_a_trace_is_drawn_as_a_whole(manycore, simulated: Path, tmp_path: Path) -> None:
    picture = tmp_path / "chip.svg"
    manycore("view", "--file", simulated, "--once", "-o", picture)
    texts = {one.text for one in ElementTree.parse(picture).iter() if one.text}
    assert {"/camera", "/filter", "/sink", "/image", "30 %"} <= texts


@pytest.mark.needs("chromium", "chromedriver", "selenium", "aiohttp")
def test_a_real_run_is_seen_above_a_simulated_one(
    start, browser, measured: Path, simulated: Path
) -> None:
    program = start(forked_manycore("view", "--port", "0", "--file", measured, "--file", simulated))
    browser.open(program.wait_for(r"http://\S+").group())
    above, below = browser.all("iframe")
    assert above.location["y"] < below.location["y"]

    def go_to(page: object) -> None:
        browser.driver.switch_to.default_content()
        browser.driver.switch_to.frame(page)

    go_to(above)
    browser.wait_for_text("#state", "measured.csv")
    browser.wait_for_text("#chains", "communication /chatter")
    browser.find("[data-node='/talker']")
    go_to(below)
    browser.wait_for_text("#state", "simulated.json")
    browser.wait_for_text("#chains", "communication /image")
    browser.wait_for_text("#moment-text", "the whole run")
    browser.click("[data-node='/filter']")
    browser.wait_for_text("#details-facts", "CPU 30 %")
    assert browser.text("#endpoints small") == ""  # a simulation has neither types nor QoS
    assert not browser.find("#trace").is_displayed()  # nothing runs that could be traced
    browser.driver.execute_script("moment.value = 0; moment.dispatchEvent(new Event('input'))")
    browser.wait_for_text("#moment-text", "0.00 s")
    browser.wait_for_text("#details-facts", "CPU 0 %")

    go_to(above)
    browser.wait_for_text("#moment-text", "0.00 s")
    browser.wait_for_text("#details-title", "/filter")
    browser.wait_for_text("#details-facts", "not there")
    browser.click("#play")
    browser.until(lambda: browser.text("#moment-text") != "0.00 s", "it plays")
    go_to(below)
    browser.click("#whole")
    go_to(above)
    browser.wait_for_text("#moment-text", "the whole run")
    assert browser.text("#play") == "Play"  # what was chosen below has ended it
    browser.click("#play")
    browser.until(lambda: browser.text("#play") == "Play", "it has played to the end")
    go_to(below)
    browser.until(lambda: browser.text("#moment-text") != "the whole run", "it has followed")
    assert browser.complaints() == []
    assert program.stop() == 0, program


def test_what_cannot_be_shown_is_refused(manycore, simulated: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.json"
    other.write_text("{}")
    twice = ("--file", simulated, "--file", simulated, "--once", "-o", tmp_path / "chip.svg")
    for words, status, text in (
        (("--file", tmp_path / "missing.json"), 1, "missing.json: cannot be read"),
        (("--file", other), 2, "other.json"),
        (twice, 2, "--once draws one --file"),
        (("--file", simulated, "--platform", "other"), 2, "--platform is for a platform"),
        (("--file", simulated, "--period", "1"), 2, "--period is for a platform"),
        (("--once", "-o", tmp_path / "chip.svg"), 2, "--port is for a page"),
    ):
        assert text in manycore("view", "--port", "0", *words, status=status), words
