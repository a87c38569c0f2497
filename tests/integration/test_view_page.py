# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The page of `manycore view` in a real browser."""

from __future__ import annotations

import re
import signal

import pytest

from rmw_manycore_py.picture.drawing import draw
from rmw_manycore_py.picture.layout import lay_out
from rmw_manycore_py.trace.files import load
from support import IS_MANYCORE, wait_until
from support.peers.programs import forked_example, forked_manycore
from support.samples.mappings import mapping

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("chromium", "chromedriver", "selenium", "aiohttp"),
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

# A screen reader names elements of these roles; without a name they are silent.
NAMED_ROLES = ("button", "checkbox", "group", "heading", "link", "list", "log", "region")
NAMED_ROLES += ("searchbox", "slider", "status")
NAMELESS = ("list", "log", "status")  # read by their content


def test_a_platform_is_seen_from_start_to_end(view, browser, start, platform) -> None:
    _, link = view
    browser.open(link)
    browser.wait_for_text("#state", f"waiting for platform {platform} to start")

    listener = start(forked_example("listener"), cluster=2)
    talker = start(forked_example("talker"), MANYCORE_CORE="3")
    browser.find("[data-node='/talker']")
    browser.find("[data-topic='/chatter']:not(.rate0)")
    assert "core 3" in browser.text("#picture")

    browser.click("[data-node='/talker']")
    browser.wait_for_text("#details-facts", f"pid {talker.pid}")
    browser.until(lambda: browser.text("#endpoints b") == "/chatter", "its own topic is first")
    browser.wait_for_text("#endpoints", "reliable, volatile, keep last 10")
    browser.click("#parameters")
    browser.wait_for_text("#parameters-text", "rate_hz")

    browser.click("#trace")
    browser.wait_for_text("#trace", "Stop and save")
    browser.click("[data-topic='/chatter']")
    browser.wait_for_text("#details-facts", "99 % below")
    browser.find("#details-charts canvas")
    browser.click("#trace")
    browser.wait_for_text("#chains", "communication /chatter")
    browser.driver.execute_script("document.querySelector('#trace-file').click()")
    file = browser.downloads / f"{platform}-1.json"
    wait_until(file.exists, "the trace is downloaded")
    assert load(file).event_count > 0

    talker.signal(signal.SIGKILL)
    browser.find("g.dead[data-node='/talker']")
    browser.wait_for_text("#happened .died", "/talker died")
    start(forked_example("talker"), MANYCORE_CORE="3")
    browser.until(
        lambda: browser.all("[data-node='/talker']") and not browser.all("g.dead"), "it is back"
    )
    assert browser.complaints() == []
    listener.kill()


def test_messages_of_a_topic_are_shown(talking, view, browser) -> None:
    browser.open(view[1])
    browser.click("[data-topic='/chatter']")
    browser.find("#picture svg.choosing .topic.selected.related")
    browser.click("#samples")
    browser.wait_for_text("#samples-fields [data-path='data']", "Hello World")
    browser.click("#samples")
    browser.wait_for_text("#samples", "Show messages")
    assert browser.complaints() == []


def test_a_number_is_plotted_while_its_field_is_chosen(talking, view, browser) -> None:
    browser.open(view[1])
    browser.find("[data-node='/talker']")
    browser.driver.execute_script(
        "document.evaluate(\"//button[.='topic /rosout']\", document).iterateNext().click()"
    )
    browser.click("#samples")
    number = "#samples-fields [data-path='stamp.sec'] button"
    browser.click(number)
    browser.wait_for_text("#samples-plot figcaption", "stamp.sec")
    browser.find("#samples-plot canvas")
    browser.find(f"{number}[aria-pressed='true']")
    browser.click(number)
    browser.until(lambda: not browser.all("#samples-plot canvas"), "the plot is gone")
    assert browser.complaints() == []


# The chip shrinks to 0.7 of its size, and only then is a part of it out of sight.
SIZES = """
const chip = document.querySelector("#picture svg");
const ratio = chip.clientWidth / chip.viewBox.baseVal.width;
return [stage.clientHeight, document.documentElement.scrollWidth, innerWidth, ratio,
  stage.scrollWidth > stage.clientWidth];
"""


def test_the_chip_is_seen_at_any_width(talking, view, browser) -> None:
    from support.processes.browser import WINDOW

    browser.open(view[1])
    browser.find("[data-node='/talker']")
    for width in (400, 800, 1200):
        browser.driver.set_window_size(width, 800)
        height, needed, given, ratio, is_cut = browser.driver.execute_script(SIZES)
        assert height >= 200, width
        assert needed <= given, width
        assert ratio >= 0.7 - 1e-3, width
        assert not is_cut or ratio <= 0.7 + 1e-3, width
    browser.driver.set_window_size(*WINDOW)


OVERLAPS = """
const texts = [...document.querySelectorAll("text")].filter((one) => one.textContent);
const boxes = texts.map((one) => one.getBBox());
const meet = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height
  && b.y < a.y + a.height;
const isOfOneLabel = (one, other) => one.parentNode === other.parentNode;
return texts.flatMap((one, i) => texts.slice(i + 1).filter((other, j) =>
  meet(boxes[i], boxes[i + 1 + j]) && !isOfOneLabel(one, other)
).map((other) => [one.textContent, other.textContent]));
"""


def test_no_text_of_a_crowded_picture_covers_another_one(browser, tmp_path) -> None:
    """With the fonts of a browser, of which the layout knows no more than a mean width."""
    layout = lay_out(mapping(6, 40), [])
    marks = {arc.label_id: {"text": "1.2 kHz · 123456 lost · 9.9 GiB"} for arc in layout.arcs}
    marks |= {cell.cpu_id: {"text": "100 %"} for cell in layout.cells}
    file = tmp_path / "chip.html"
    file.write_text(f"<body>{draw('p', layout, marks)}</body>")
    browser.open(f"file://{file}")
    assert len(browser.all("text")) > 100
    assert browser.driver.execute_script(OVERLAPS) == []


def test_a_node_of_a_run_is_restarted_and_moved(view, browser, start, tmp_path) -> None:
    mapfile = tmp_path / "map.yaml"
    mapfile.write_text(
        "nodes:\n  talker: {cluster: 1, module: rmw_manycore_py.examples.talker, core: 1}\n"
    )
    run = start(forked_manycore("run", mapfile))
    browser.open(view[1])
    browser.click("[data-node='/talker']")
    browser.wait_for_text("#details-facts", "cluster 1, core 1")
    first = pid_on(browser)
    ask(browser, "#restart", "talker started")
    browser.until(lambda: pid_on(browser) not in (first, None), "another process")
    browser.driver.execute_script("place.value = '2:3'")
    ask(browser, "#move", "talker started")
    browser.wait_for_text("#details-facts", "cluster 2, core 3")
    browser.driver.execute_script("place.value = '99:-1'")
    ask(browser, "#move", "expected a cluster such as 2")
    assert run.stop() == 0


def ask(browser, selector: str, answer: str) -> None:
    """Click a button that asks for confirmation, confirm, and await the answer."""
    from selenium.webdriver.support.expected_conditions import alert_is_present

    browser.find(f"{selector}:enabled")
    click = f"setTimeout(() => document.querySelector('{selector}').click())"
    browser.driver.execute_script(click)
    browser.until(lambda: alert_is_present()(browser.driver), "the question").accept()
    browser.wait_for_text("#control-text", answer)


def pid_on(browser) -> str | None:
    found = re.search(r"pid \d+", browser.text("#details-facts"))
    return found.group() if found else None


def test_two_pages_see_the_end_of_a_platform(talking, view, browser) -> None:
    viewer, link = view
    browser.open(link)
    browser.find("[data-node='/talker']")
    browser.open_in_new_tab(link)
    browser.find("[data-node='/listener']")
    for program in talking:
        program.stop()
    for _ in browser.tabs():
        browser.wait_for_text("#state", "has ended; waiting for it to start again")
    assert viewer.stop() == 0
    browser.wait_for_text("#state", "manycore view has ended, or cannot be reached")


def test_the_keyboard_goes_everywhere(talking, view, browser, start) -> None:
    browser.open(view[1])
    browser.press("[data-node='/talker']", "Enter")
    browser.wait_for_text("#details-title", "/talker")
    browser.until(lambda: browser.focused("id") == "details-title", "the title has the focus")
    browser.press(None, "Escape")
    browser.until(lambda: browser.focused("data-node") == "/talker", "the node has the focus")

    browser.press(None, "/", *"chat", "Tab")
    browser.until(lambda: browser.focused_text() == "topic /chatter", "the only one found")
    start(forked_example("lamp"))  # the list is rebuilt
    browser.find("[data-node='/lamp']")
    assert browser.focused_text() == "topic /chatter"
    browser.press(None, "Enter")
    browser.wait_for_text("#details-title", "/chatter")
    browser.wait_for_text("#endpoints li", "reliable")
    browser.click("#details-close")
    browser.until(lambda: browser.focused_text() == "topic /chatter", "the way back")
    assert browser.complaints() == []


def test_a_screen_reader_has_names_and_values(talking, view, browser) -> None:
    browser.open(view[1])
    browser.find("[data-node='/talker']")
    browser.find("[data-topic='/chatter']")
    browser.find("#charts output")
    tree = browser.accessible()
    silent = [role for role, name in tree if role in NAMED_ROLES and not name]
    assert [role for role in silent if role not in NAMELESS] == []
    names = {name for role, name in tree if role == "button"}
    assert {"/talker, node, cluster 1", "topic /chatter", "Start trace"} <= names
    assert ("heading", "Events") in tree
    assert not [name for role, name in tree if role == "Canvas"], "pictures for the eye alone"


def test_light_and_dark_are_chosen(view, browser) -> None:
    browser.open(view[1])
    shown = "return getComputedStyle(document.body).backgroundColor"
    before = browser.driver.execute_script(shown)
    browser.click("#theme")
    assert browser.driver.execute_script(shown) != before
    browser.click("#theme")
    assert browser.driver.execute_script(shown) == before


def test_events_appear_once_and_lead_to_their_node(talking, view, browser) -> None:
    """Also after a lost connection: the server then sends everything again."""
    browser.keep_sockets()
    browser.open(view[1])
    browser.find("[data-node='/talker']")
    talking[0].signal(signal.SIGKILL)
    browser.wait_for_text("#happened .died", "/talker died")
    told = browser.text("#happened")
    browser.driver.execute_script("sockets[0].close(); happened.lastChild.id = 'oldest'")
    browser.until(lambda: not browser.all("#oldest"), "the list is new")
    again = browser.text("#happened")
    assert again.endswith(told)  # later ones, such as losses of a slow listener, are before
    assert again.count("/talker died") == told.count("/talker died")
    browser.click("#happened button[aria-label='show /talker']")
    browser.wait_for_text("#details-facts", "died")
