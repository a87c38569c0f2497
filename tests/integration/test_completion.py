# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What real shells complete, on a running platform."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from ros_support import announce, peer_node
from support import IS_MANYCORE, environment, manycore_command, peer_command

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not IS_MANYCORE, reason="manycore is about rmw_manycore"),
]

# Each calls the completion of a line as its shell does for Tab, and prints what that offers.
BASH = """
eval "$(manycore completion bash)"
COMP_LINE="$1"; COMP_WORDS=($COMP_LINE); [[ $1 == *" " ]] && COMP_WORDS+=("")
COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
compopt() { echo "compopt $*"; }
function=$(complete -p manycore | sed 's/.* -F \\([^ ]*\\) .*/\\1/')
$function manycore "${COMP_WORDS[COMP_CWORD]}"
printf '%s\\n' "${COMPREPLY[@]}"
"""
# Only inside of its line editor does zsh complete, so the functions that show the result stand in.
ZSH = """
compdef() { :; }
compadd() { while [[ $1 == -* ]]; do [[ $1 == -V ]] && shift; shift; done; print -l ${(P)1}; }
_describe() { print -l ${${(P)3}%%:*}; }
_path_files() { echo "files $*"; }
eval "$(manycore completion zsh)"
words=(${(z)1}); [[ $1 == *" " ]] && words+=("")
CURRENT=$#words
_manycore_completion
"""
FISH = """
manycore completion fish | source
complete --do-complete "$argv[1]" | string replace --regex '\\t.*' ''
true
"""


def talking() -> None:
    import rclpy
    from std_msgs.msg import String
    from std_srvs.srv import SetBool

    with peer_node("talker") as node:
        node.create_publisher(String, "chatter", 1)
        node.create_publisher(String, "_hidden", 1)
        node.create_service(SetBool, "switch", lambda _request, response: response)
        announce("ready")
        rclpy.spin(node)


@pytest.fixture
def complete(start, platform):
    """Return a function that completes a line in a shell with the talker running."""
    start(peer_command(talking)).wait_for("ready")
    program = Path(manycore_command()[0])

    def offered(command: list[str], line: str, directory: Path) -> list[str]:
        variables = environment(platform)
        path = f"{program.parent}:{variables['PATH']}"
        done = subprocess.run(
            [*command, line],
            env={**variables, "PATH": path, "HOME": str(directory)},
            cwd=directory,
            text=True,
            capture_output=True,
            check=True,
        )
        assert done.stderr == ""
        return done.stdout.split()

    return offered


def test_bash_completes(complete, tmp_path) -> None:
    (tmp_path / "my_map.yaml").touch()

    def offered(line: str) -> list[str]:
        return complete(["bash", "--norc", "-c", BASH, "bash"], line, tmp_path)

    assert offered("manycore top") == ["top", "topic"]
    assert offered("manycore node ") == ["list", "info"]
    assert offered("manycore topic echo --qos-d") == ["--qos-durability", "--qos-depth"]
    assert offered("manycore topic echo --qos-profile sen") == ["sensor_data"]
    assert offered("manycore topic echo /ch") == ["/chatter"]
    assert "/_hidden" not in offered("manycore topic echo /")
    assert offered("manycore topic pub /chatter ") == ["std_msgs/msg/String"]
    assert offered("manycore topic pub /new std_msgs/msg/Str") == ["std_msgs/msg/String"]
    assert offered("manycore node info ") == ["/talker"]
    assert offered("manycore service call /sw") == ["/switch"]
    assert offered("manycore run talker_l") == ["talker_listener"]
    assert offered("manycore run my") == ["my_map.yaml"]
    assert offered("manycore run ./my") == ["compopt", "-o", "default"]
    assert offered("manycore interface show std_srvs/srv/Set") == ["std_srvs/srv/SetBool"]
    assert offered("manycore topic echo --platform no-such /ch") == []


@pytest.mark.parametrize(
    ("shell", "command"), [("zsh", ["-f", "-c", ZSH, "zsh"]), ("fish", ["--no-config", "-c", FISH])]
)
def test_other_shells_complete(complete, tmp_path, shell: str, command: list[str]) -> None:
    found = shutil.which(shell)
    if found is None:
        pytest.skip(f"{shell} is not installed")
    for line, expected in (
        ("manycore top", ["top", "topic"]),
        ("manycore topic echo /ch", ["/chatter"]),
        ("manycore run talker_l", ["talker_listener"]),
    ):
        assert complete([found, *command], line, tmp_path) == expected


def test_how_to_switch_it_on_is_printed(start) -> None:
    for shell, line in (
        ("/bin/bash", 'eval "$(manycore completion bash)"'),
        ("/usr/bin/fish", "manycore completion fish | source"),
    ):
        printed = start(manycore_command("completion"), SHELL=shell)
        assert printed.wait() == 0
        assert printed.lines[1].strip() == line
        assert len(printed.lines) == 3
