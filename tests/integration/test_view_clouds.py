# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Clouds on the page of `manycore view`, in a real browser."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from support import IS_MANYCORE, MAPFILES, TIMEOUT_S
from support.peers.programs import forked_manycore

pytestmark = [
    pytest.mark.integration,
    pytest.mark.needs("chromium", "chromedriver", "selenium", "aiohttp"),
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

# Latched clouds: a square of 20 x 10 m, its north-eastern corner higher, far from the map's origin;
# a map in the same frame, another one in another frame, and a cloud without points. The first map
# is published again in each frame that comes by a message, and without points to clear it.
CLOUDS = """
import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Empty, String
from rmw_manycore_py.ndt.messages.point_cloud import encode

rclpy.init()
kept = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
corners = np.array([[0, 0, 0], [20, 0, 0], [0, 10, 0], [20, 10, 8]]) + [300.0, 5e6, 40.0]
clouds = {
    "square": (corners, "map"), "city": (corners + [5, 5, 0], "map"),
    "above": (corners, "elsewhere"), "nothing": (corners[:0], "map"),
}
nodes = [rclpy.create_node(f"node_of_{name}") for name in clouds]
publishers = {
    name: node.create_publisher(PointCloud2, name, kept) for node, name in zip(nodes, clouds)
}

def publish(name, frame, count=4):
    publishers[name].publish(encode(clouds[name][0][:count], Time(), frame))

for name, (_, frame) in clouds.items():
    publish(name, frame)
nodes[0].create_subscription(String, "frame", lambda words: publish("city", words.data), 10)
nodes[0].create_subscription(Empty, "clear", lambda _: publish("city", "map", 0), 10)
print("published", flush=True)
rclpy.spin(nodes[0])
"""

# Index and bytes of each pixel that differs from the first one, which is background.
PIXELS = """
const { width, height } = document.getElementById("cloud-canvas");
const rows = height - arguments[0];
const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
copy.drawImage(document.getElementById("cloud-canvas"), 0, 0);
const values = new Uint32Array(copy.getImageData(0, 0, width, rows).data.buffer);
const drawn = [0, values[0]];
values.forEach((value, index) => { if (value !== values[0]) drawn.push(index, value); });
return [width, drawn];
"""
BACK, GREY = (18, 22, 28), (112, 125, 138)
SCALE_ROWS = 40


def pixels_by_colour(browser) -> dict[tuple[int, ...], np.ndarray]:
    """Return x and y (up) of the pixels of each colour, without the rows of the scale."""
    width, drawn = browser.driver.execute_script(PIXELS, SCALE_ROWS)
    indices, values = np.array(drawn, np.uint32).reshape(-1, 2).T
    pixels = np.column_stack([indices % width, -(indices // width).astype(int)])
    colours = values.astype("<u4").view(np.uint8).reshape(-1, 4)[:, :3]
    found: dict[tuple[int, ...], np.ndarray] = {
        colour: pixels[(colours == colour).all(axis=1)]
        for colour in map(tuple, np.unique(colours, axis=0).tolist())
    }
    del found[BACK]
    return found


def show_messages(browser, topic: str) -> None:
    """Select a topic in the list and show its messages."""
    path = f"//button[.='topic {topic}']"
    find = "const found = document.evaluate(arguments[0], document).iterateNext();"
    click = f"{find} found?.click(); return found !== null"  # at once: the list is rebuilt
    browser.until(lambda: browser.driver.execute_script(click, path), topic)
    browser.wait_for_text("#details-title", topic)
    browser.click("#samples")
    browser.wait_for_text("#samples", "Stop")


@pytest.fixture
def clouds(start, view, browser):
    """Publish CLOUDS and open the page."""
    start([sys.executable, "-c", CLOUDS]).wait_for("published")
    browser.open(view[1])
    return browser


def corners_on(browser) -> np.ndarray:
    """Return the pixels of the south-western, south-eastern and north-western corners."""
    colours = pixels_by_colour(browser)
    (low,) = (colour for colour in colours if colour != GREY and colour[2] > colour[0])
    x, y = colours[low].T
    middle = (x.min() + x.max()) / 2, (y.min() + y.max()) / 2
    inside = [(x < middle[0]) & (y < middle[1]), (x > middle[0]), (y > middle[1])]
    return np.array([colours[low][one].mean(axis=0) for one in inside])


def test_a_cloud_is_drawn_from_above_on_the_map_of_its_frame(clouds) -> None:
    show_messages(clouds, "/square")
    clouds.wait_for_text("#cloud-text", "4 points in frame 'map'")
    clouds.wait_for_text("#cloud-text", "height 40.0 m (blue) to 47.5 m (red); grey: /city")
    south_west, south_east, north_west = corners_on(clouds)
    px_per_metre = (south_east - south_west)[0] / 20
    assert px_per_metre > 1
    np.testing.assert_allclose(south_east - south_west, [20 * px_per_metre, 0], atol=1)
    np.testing.assert_allclose(north_west - south_west, [0, 10 * px_per_metre], atol=1)
    colours = pixels_by_colour(clouds)
    (high,) = (colour for colour in colours if colour != GREY and colour[0] > colour[2])
    np.testing.assert_allclose(
        colours[high].mean(axis=0) - south_west, [20 * px_per_metre, 10 * px_per_metre], atol=1
    )
    np.testing.assert_allclose(
        colours[GREY].min(axis=0) - south_west, [5 * px_per_metre, 5 * px_per_metre], atol=1.5
    )
    assert clouds.complaints() == []


def test_a_map_that_goes_to_another_frame_is_no_longer_drawn(clouds, manycore) -> None:
    show_messages(clouds, "/square")
    clouds.wait_for_text("#cloud-text", "grey: /city")
    assert GREY in pixels_by_colour(clouds)
    manycore("topic", "pub", "--once", "/frame", "std_msgs/msg/String", "data: elsewhere")
    clouds.until(lambda: "grey" not in clouds.text("#cloud-text"), "the text without a map")
    assert GREY not in pixels_by_colour(clouds)
    assert clouds.complaints() == []


def test_a_map_that_is_cleared_is_no_longer_drawn(clouds, manycore) -> None:
    show_messages(clouds, "/square")
    clouds.wait_for_text("#cloud-text", "grey: /city")
    manycore("topic", "pub", "--once", "/clear", "std_msgs/msg/Empty")
    clouds.until(lambda: "grey" not in clouds.text("#cloud-text"), "the text without a map")
    assert GREY not in pixels_by_colour(clouds)
    manycore("topic", "pub", "--once", "/frame", "std_msgs/msg/String", "data: map")
    clouds.wait_for_text("#cloud-text", "grey: /city")
    assert GREY in pixels_by_colour(clouds)
    assert clouds.complaints() == []


def turn_wheel(browser, x: int, y: int, amount: int) -> None:
    """Turn the wheel over the picture, these pixels right of and below its middle."""
    from selenium.webdriver import ActionChains
    from selenium.webdriver.common.actions.wheel_input import ScrollOrigin

    origin = ScrollOrigin.from_element(browser.find("#cloud-canvas"), x, y)
    before = corners_on(browser)
    ActionChains(browser.driver).scroll_from_origin(origin, 0, amount).perform()
    browser.until(lambda: not np.allclose(corners_on(browser), before, atol=2), "the wheel zooms")


def fixed_point(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Return what stayed in its place while the corners were scaled."""
    scale = np.ptp(after[:, 0]) / np.ptp(before[:, 0])
    point: np.ndarray = np.mean(after - scale * before, axis=0) / (1 - scale)
    return point


def test_the_wheel_zooms_about_the_middle_while_following(clouds) -> None:
    from selenium.webdriver import ActionChains

    show_messages(clouds, "/square")
    clouds.wait_for_text("#cloud-text", "grey: /city")
    canvas = clouds.find("#cloud-canvas")
    middle = np.array([canvas.size["width"], -canvas.size["height"]]) / 2
    fitted = corners_on(clouds)
    turn_wheel(clouds, 100, 60, 400)
    small = corners_on(clouds)
    np.testing.assert_allclose(fixed_point(fitted, small), middle, atol=3)
    ActionChains(clouds.driver).drag_and_drop_by_offset(canvas, 30, -20).perform()
    panned = corners_on(clouds)
    turn_wheel(clouds, 100, 60, -200)
    pointer = middle + np.array([100, -60])
    np.testing.assert_allclose(fixed_point(panned, corners_on(clouds)), pointer, atol=5)


def test_the_picture_of_a_cloud_is_moved_and_zoomed(clouds) -> None:
    from selenium.webdriver import ActionChains

    show_messages(clouds, "/square")
    clouds.wait_for_text("#cloud-text", "grey: /city")
    fitted = corners_on(clouds)
    clouds.click("#cloud-out")
    small = corners_on(clouds)
    np.testing.assert_allclose(1.5 * np.diff(small, axis=0), np.diff(fitted, axis=0), atol=2)
    canvas = clouds.find("#cloud-canvas")
    ActionChains(clouds.driver).drag_and_drop_by_offset(canvas, 30, -20).perform()
    np.testing.assert_allclose(corners_on(clouds) - small, [[30, 20]] * 3, atol=1)
    clouds.click("#cloud-fit")
    np.testing.assert_allclose(corners_on(clouds), fitted, atol=1)
    turn_wheel(clouds, 0, 0, 100)
    assert np.ptp(corners_on(clouds)[:, 0]) < 0.9 * np.ptp(fitted[:, 0])


def test_a_cloud_without_points_is_a_text(clouds) -> None:
    show_messages(clouds, "/nothing")
    clouds.wait_for_text("#cloud-text.alarm", "the cloud is empty")
    assert not clouds.find("#cloud-canvas").is_displayed()
    show_messages(clouds, "/square")
    clouds.wait_for_text("#cloud-text:not(.alarm)", "4 points")
    assert clouds.find("#cloud-canvas").is_displayed()


def test_an_aligned_scan_is_seen_in_the_map(view, browser, start, street) -> None:
    run = start(forked_manycore("run", MAPFILES / "ndt_offload.yaml"))
    run.wait_for("ndt_scan_matcher started")
    browser.open(view[1])
    show_messages(browser, "/points_aligned")
    patiently = ("--wait", "--timeout", 2 * TIMEOUT_S, "--deadline", 1e3 * TIMEOUT_S)
    replay = start(forked_manycore("ndt", "replay", street / "drive.npz", *map(str, patiently)))
    browser.wait_for_text("#cloud-text", "points in frame 'map'")
    browser.wait_for_text("#cloud-text", "grey: /pointcloud_map")
    browser.wait_for_text("#cloud-judgement:not(.alarm)", "newest scan: believed")
    colours = pixels_by_colour(browser)
    assert len(colours) > 50
    assert len(colours[GREY]) > 1000
    assert replay.wait(2 * TIMEOUT_S) == 0, replay
    assert browser.complaints() == []


def test_scans_without_a_cloud_are_judged_too(view, browser, start, street) -> None:
    run = start(forked_manycore("run", MAPFILES / "ndt_offload.yaml"))
    run.wait_for("ndt_scan_matcher started")
    browser.open(view[1])
    show_messages(browser, "/points_aligned")
    start(forked_manycore("ndt", "replay", street / "drive.npz", "--no-map", "--timeout", "30"))
    browser.wait_for_text("#cloud-judgement.alarm", "newest scan: refused: there is no map yet")
    assert not browser.find("#cloud-canvas").is_displayed()
