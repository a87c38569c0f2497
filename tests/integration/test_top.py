# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore top`: into a pipe, on a terminal, and as a background job."""

from __future__ import annotations

import json
import signal

import pytest

from support import IS_MANYCORE
from support.peers.programs import forked_manycore
from support.processes.commands import manycore_command
from support.processes.person import Person
from support.processes.platforms import environment

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

WHOLE_SCREEN = "\x1b\\[\\?1049h"
USUAL_SCREEN = "\x1b\\[\\?1049l"


@pytest.fixture
def at_a_terminal(platform):
    """Return a function that starts a command at a terminal."""
    people = []

    def sit_down(*command: object, term: str = "xterm") -> Person:
        env = {**environment(platform), "TERM": term}
        people.append(Person(list(map(str, command)), env))
        return people[-1]

    yield sit_down
    for person in people:
        person.close()


def test_top_shows_nodes_and_topics(talking, start, platform) -> None:
    talker, _ = talking
    top = start(forked_manycore("top", "--json", "--period", "0.6"))
    moved = r'^\{.*"topic": "/chatter", "messages_per_s": (?!0\.0,).*'
    look = json.loads(top.wait_for(moved).group())
    assert top.stop() == 0, top
    nodes = {row["node"]: row for row in look["nodes"]}
    assert (nodes["/talker"]["pid"], nodes["/talker"]["core"]) == (talker.pid, 3)
    topics = {row["topic"]: row for row in look["topics"]}
    assert topics["/chatter"]["messages_per_s"] > 0
    assert {row["cluster"] for row in look["clusters"]} == {1, 2}
    plain = start(forked_manycore("top", "--count", "1", "--period", "0.1", "--filter", "chat"))
    assert plain.wait() == 0
    assert "/chatter" in plain.output
    assert "/talker" not in plain.output
    talker.signal(signal.SIGKILL)


def test_keys_choose_what_a_terminal_shows(talking, at_a_terminal) -> None:
    person = at_a_terminal(*manycore_command("top"))
    person.sees(WHOLE_SCREEN)
    person.sees("/talker")
    person.type("n")
    person.sees("nodes by cluster")
    person.type("/chat\r")
    person.sees("with 'chat'")
    person.type("q")
    person.sees(USUAL_SCREEN)
    assert person.leaves() == 0


def test_a_dumb_terminal_is_printed_to(talking, at_a_terminal) -> None:
    person = at_a_terminal(*manycore_command("top", "--count", "1"), term="dumb")
    assert "\x1b" not in person.sees(r"(?s)(.*)/chatter")[1]
    assert person.leaves() == 0


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_leaves_the_terminal_as_it_was(talking, at_a_terminal, end) -> None:
    person = at_a_terminal(*manycore_command("top"))
    person.sees("/talker")
    person.process.send_signal(end)
    person.sees(USUAL_SCREEN)
    assert person.leaves() == 0


def test_in_the_background_it_prints_and_leaves_the_terminal_alone(talking, at_a_terminal) -> None:
    """If the kernel had stopped the job, the shell's wait would return 128 + SIGTTOU."""
    top = " ".join(map(str, manycore_command("top", "--count", "2", "--period", "0.2")))
    person = at_a_terminal("bash", "-mc", f"{top} & wait $!; echo status $?")
    said = person.sees(r"(?s)(.*)status (\d+)\s")
    assert said[2] == "0"
    assert "/talker" in said[1]
    assert "\x1b[?" not in said[1]
    assert person.leaves() == 0


def test_stopped_it_gives_the_terminal_back(talking, at_a_terminal) -> None:
    top = " ".join(map(str, manycore_command("top")))
    person = at_a_terminal("bash", "-mc", f"{top}; echo status $?; stty -a; fg; echo over")
    person.sees("/talker")
    person.type("\x1a")
    assert "\x1b[?1049l" in person.sees(r"(?s)(.*)status 14\d\s")[1]  # 128 + SIGSTOP or SIGTSTP
    assert " icanon" in person.sees(r"(?s)speed(.*)echoke")[1]
    person.sees(WHOLE_SCREEN)
    person.sees("/listener")
    person.type("q")
    person.sees("over")
    assert person.leaves() == 0
