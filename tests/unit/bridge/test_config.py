# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Bridge files in domain_bridge's schema."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmw_manycore_bridge.config import load_bridge_file
from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.routes.route import Route

pytestmark = pytest.mark.unit

STRING = "{type: std_msgs/msg/String}"


def load(directory: Path, text: str, inside: int = 2) -> tuple[Route, ...]:
    path = directory / "bridge.yaml"
    path.write_text(text)
    return load_bridge_file(path, inside)


def ways(routes: tuple[Route, ...]) -> list[tuple[str, str, str, int]]:
    return [(r.direction, r.inside, r.outside, r.domain) for r in routes]


def test_one_name_several_times(tmp_path) -> None:
    routes = load(
        tmp_path,
        "name: my_bridge\nfrom_domain: 2\nto_domain: 3\ntopics:\n"
        f"  chatter: {STRING}\n"
        "  chatter: {type: std_msgs/msg/String, to_domain: 4}\n"
        "  chatter: {type: std_msgs/msg/String, reversed: True}\n"
        "  chatter: {type: std_msgs/msg/String, remap: chitter}\n",
    )
    assert ways(routes) == [
        ("outward", "/chatter", "/chatter", 3),
        ("outward", "/chatter", "/chatter", 4),
        ("inward", "/chatter", "/chatter", 3),
        ("outward", "/chatter", "/chitter", 3),
    ]
    assert all(route.mirrored for route in routes)


def test_the_platform_may_be_the_target(tmp_path) -> None:
    routes = load(tmp_path, f"from_domain: 3\nto_domain: 2\ntopics: {{a: {STRING}}}\n")
    assert ways(routes) == [("inward", "/a", "/a", 3)]
    assert not routes[0].mirrored


def test_both_directions_keep_the_new_name_on_each_target(tmp_path) -> None:
    topic = "{type: std_msgs/msg/String, bidirectional: true, remap: b}"
    routes = load(tmp_path, f"from_domain: 2\nto_domain: 3\ntopics: {{a: {topic}}}\n")
    assert ways(routes) == [("outward", "/a", "/b", 3), ("inward", "/b", "/a", 3)]


def test_what_joins_two_other_domains_is_left_out(tmp_path) -> None:
    path = tmp_path / "bridge.yaml"
    path.write_text(
        "from_domain: 2\nto_domain: 3\ntopics:\n"
        f"  a: {STRING}\n"
        "  a: {type: std_msgs/msg/String, from_domain: 7, to_domain: 8}\n"
    )
    notes: list[str] = []
    assert ways(load_bridge_file(path, 2, notes.append)) == [("outward", "/a", "/a", 3)]
    (note,) = notes
    assert "5: topics.a: expected 2, the platform's domain" in note
    assert note.endswith("found 7 and 8; skipped")


def test_an_empty_new_name_is_none(tmp_path) -> None:
    topic = "{type: std_msgs/msg/String, remap: '', qos: {lifespan: -5, deadline: auto}}"
    routes = load(tmp_path, f"from_domain: 2\nto_domain: 3\ntopics: {{a: {topic}}}\n")
    assert ways(routes) == [("outward", "/a", "/a", 3)]


def test_a_pattern_has_no_type(tmp_path) -> None:
    limits = "{bidirectional: true, max_hz: 5}"
    routes = load(
        tmp_path,
        f"from_domain: 2\nto_domain: 3\ntopics:\n  camera/*:\n  /lidar/**: {limits}\n",
    )
    assert ways(routes) == [
        ("outward", "/camera/*", "/camera/*", 3),
        ("outward", "/lidar/**", "/lidar/**", 3),
        ("inward", "/lidar/**", "/lidar/**", 3),
    ]
    assert all(route.is_pattern and route.type == "" for route in routes)
    assert [route.max_hz for route in routes] == [None, 5, 5]


def test_policies(tmp_path) -> None:
    qos = "{reliability: best_effort, depth: 3, deadline: 5, lifespan: auto, history: keep_last}"
    (route,) = load(
        tmp_path,
        "from_domain: 2\nto_domain: 3\n"
        f"topics: {{a: {{type: std_msgs/msg/String, qos: {qos}, max_hz: 10, max_size: 1KiB}}}}\n",
    )
    assert route.qos == {
        "reliability": "best_effort",
        "depth": 3,
        "deadline_ns": 5,
        "history": "keep_last",
    }
    assert (route.max_hz, route.max_size) == (10, 1024)


def test_a_server_is_in_the_first_domain(tmp_path) -> None:
    routes = load(
        tmp_path,
        "from_domain: 2\nto_domain: 3\n"
        "services: {lamp: {type: std_srvs/srv/SetBool, timeout: 5}}\n"
        "actions: {count: {type: test_msgs/action/Fibonacci}}\n",
    )
    assert ways(routes)[0] == ("inward", "/lamp", "/lamp", 3)
    assert routes[0].timeout_s == 5
    feedback = next(route for route in routes if route.inside == "/count/_action/feedback")
    assert (feedback.direction, feedback.kind) == ("outward", "topic")
    assert feedback.type == "test_msgs/action/Fibonacci_FeedbackMessage"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "from_domain: 2\nto_domain: 3\ntopics: {a: {}}",
            "3: topics.a.type: expected the key 'type', found no such key",
        ),
        (
            "from_domain: 2\nto_domain: 3\ntopics:\n  a*:\n    type: std_msgs/msg/String",
            "5: topics.a*.type: expected no type: each topic that fits has its own, found "
            "'std_msgs/msg/String'",
        ),
        (
            "from_domain: 2\nto_domain: 3\ntopics:\n  /a/**: {remap: b}",
            "4: topics./a/**.remap: expected no new name: topics of a pattern keep theirs",
        ),
        (
            f"to_domain: 3\ntopics:\n  a: {STRING}",
            "3: topics.a: expected the key 'from_domain' here or at the top, found no such key",
        ),
        (
            f"from_domain: 2\nto_domain: 2\ntopics:\n  a: {STRING}",
            "4: topics.a: expected two different domains, found 2 on both sides",
        ),
        (
            f"from_domain: 5\nto_domain: 6\ntopics:\n  a: {STRING}",
            "4: topics.a: expected 2, the platform's domain (--inside), on one side, found 5 and 6",
        ),
        (
            "topics:\n  a:\n    type: std_msgs/msg/String\n    qos: {reliability: maybe}",
            "4: topics.a.qos.reliability: expected input should be 'reliable' or 'best_effort', "
            "found string 'maybe'",
        ),
        ("topics: {a: {type: 5, colour: red}}", "1: topics.a.colour: expected a key of"),
        ("mode: compress", "1: mode: expected input should be 'normal', found string 'compress'"),
        ("name: nothing", "1: expected something to bridge in topics, services or actions"),
        (
            "topics: [{a: {type: std_msgs/msg/String}}]",
            "1: topics: expected a name and its settings: a mapping, no list",
        ),
        ("[]", "1: expected a mapping, found list []"),
        ("from_domain: 2024-13-01", "1: from_domain: expected a date, found '2024-13-01'"),
        ("topics: " + "[" * 1000, "1: expected at most 50 levels of nesting, found more"),
        ("topics: {[a]: b}", "1: expected valid YAML, found a key that is not a scalar"),
        ("name: \x1b", r"1: expected text of printable characters, found '\x1b'"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path, text, message) -> None:
    with pytest.raises(MapfileError) as caught:
        load(tmp_path, text + "\n")
    assert message in str(caught.value)
