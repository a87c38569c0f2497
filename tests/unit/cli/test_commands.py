# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The whole command line: every verb has a help text, and errors are one line."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from click.testing import CliRunner, Result

from rmw_manycore_py.cli.common.group import MAX_SUMMARY
from rmw_manycore_py.cli.common.seconds import Seconds
from rmw_manycore_py.cli.main import SECTIONS, VERBS, cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT

pytestmark = pytest.mark.unit

MAPFILE = """\
nodes:
  talker: {cluster: 1, core: 1, command: "true"}
"""


def manycore(*words: str) -> Result:
    return CliRunner().invoke(cli, words, prog_name="manycore")


def commands(group: click.Group = cli, *path: str) -> Iterator[tuple[str, ...]]:
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        if isinstance(command, click.Group):
            yield from commands(command, *path, name)
        else:
            yield (*path, name)


def all_commands(group: click.Group = cli) -> Iterator[tuple[str, click.Command]]:
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        yield name, command
        if isinstance(command, click.Group):
            yield from all_commands(command)


def test_every_summary_fits_into_its_line() -> None:
    summaries = {command.get_short_help_str(1000) for _, command in all_commands()}
    assert [text for text in summaries if len(text) > MAX_SUMMARY] == []


def test_summaries_in_the_help_are_those_of_the_commands() -> None:
    groups = [("manycore", cli), *all_commands()]
    for name, group in groups:
        if isinstance(group, click.Group):
            context = click.Context(group, info_name=name)
            shown = [line.split(maxsplit=1) for line in group.get_help(context).splitlines()]
            for verb in group.list_commands(context):
                command = group.get_command(context, verb)
                assert command is not None
                assert [verb, command.get_short_help_str(MAX_SUMMARY)] in shown


def test_help_loads_no_command() -> None:
    program = (
        "import sys; from rmw_manycore_py.cli.main import VERBS, cli\n"
        "cli(['--help'], standalone_mode=False)\n"
        "print([place for place in VERBS.values() if place.partition(':')[0] in sys.modules])"
    )
    assert _last_line_of(program) == "[]"


@pytest.mark.parametrize("words", [(), ("topic",), ("topic", "hz")], ids=str)
def test_help_is_the_same_without_docstrings(words: tuple[str, ...]) -> None:
    program = ("-m", "rmw_manycore_py.cli", *words, "--help")
    plain, stripped = (
        subprocess.run([sys.executable, *options, *program], stdout=subprocess.PIPE, check=True)
        for options in ([], ["-OO"])
    )
    assert stripped.stdout == plain.stdout


def test_run_does_not_load_what_few_runs_need() -> None:
    program = "import sys, rmw_manycore_py.cli.run; print('numpy' in sys.modules)"
    assert _last_line_of(program) == "False"


def _last_line_of(program: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, check=True
    )
    return done.stdout.splitlines()[-1]


def test_every_option_has_help() -> None:
    found = {(name, option) for name, command in all_commands() for option in command.params}
    options = [(name, one) for name, one in found if isinstance(one, click.Option)]
    assert [(name, one.opts) for name, one in options if not one.help] == []


@pytest.mark.parametrize("text", ["nan", "inf"])
def test_every_number_is_finite(text: str) -> None:
    accepted = []
    for name, command in all_commands():
        for option in command.params:
            is_endless = text == "inf" and isinstance(option.type, Seconds)
            if isinstance(option.type, click.types.FloatParamType) and not is_endless:
                try:
                    option.type.convert(text, option, None)
                except click.BadParameter:
                    continue
                accepted.append((name, option.opts))
    assert accepted == []


def test_every_command_is_in_a_section_of_the_help() -> None:
    assert sorted(name for names in SECTIONS.values() for name in names) == sorted(VERBS)


@pytest.fixture
def mapfile(tmp_path: Path) -> Path:
    path = tmp_path / "map.yaml"
    path.write_text(MAPFILE)
    return path


@pytest.mark.parametrize("path", [p for p in commands() if p[0] != "bench"], ids=" ".join)
def test_every_command_has_help_with_examples(path: tuple[str, ...]) -> None:
    result = manycore(*path, "--help")
    assert result.exit_code == 0
    assert f"Examples:\n    manycore {' '.join(path)}" in result.output or path == ("env",)


# Modules that extras install; the command line loads without them.
WITHOUT_EXTRAS = """
import sys
for name in ("aiohttp", "lzf", "matplotlib", "mcap", "open3d", "perfetto", "rosbags"):
    sys.modules[name] = None
from test_commands import commands
print(len(list(commands())))
"""


def test_every_command_loads_without_the_extras() -> None:
    found = subprocess.run(
        [sys.executable, "-c", WITHOUT_EXTRAS],
        cwd=Path(__file__).parent,
        capture_output=True,
        text=True,
    )
    assert found.returncode == 0, found.stderr
    assert int(found.stdout) == len(list(commands()))


def test_the_verbs_are_there() -> None:
    found = {" ".join(path) for path in commands()}
    expected = {
        "run",
        "create",
        "map init",
        "map check",
        "map show",
        "status",
        "clean",
        "doctor",
        "env",
        "topic list",
        "topic info",
        "topic echo",
        "topic hz",
        "topic pub",
        "topic bw",
        "topic delay",
        "node list",
        "node info",
        "service list",
        "service call",
        "param get",
        "param set",
        "action list",
        "action send_goal",
        "lifecycle get",
        "lifecycle set",
        "interface show",
        "top",
    }
    assert expected <= found


def test_an_unknown_verb_is_an_error() -> None:
    result = manycore("fly")
    assert result.exit_code == EXIT_BAD_INPUT
    assert "No such command 'fly'" in result.output


def needs_arguments(path: tuple[str, ...]) -> bool:
    group: click.Command = cli
    for name in path:
        assert isinstance(group, click.Group)
        found = group.get_command(click.Context(group), name)
        assert found is not None
        group = found
    return any(isinstance(one, click.Argument) and one.required for one in group.params)


@pytest.mark.parametrize("path", [p for p in commands() if needs_arguments(p)], ids=" ".join)
def test_a_missing_argument_is_named(path: tuple[str, ...]) -> None:
    result = manycore(*path)
    assert result.exit_code == EXIT_BAD_INPUT
    assert "Error: Missing " in result.output


def test_a_mapfile_that_does_not_exist() -> None:
    result = manycore("run", "no-such.yaml")
    assert result.exit_code == EXIT_BAD_INPUT
    text = " ".join(result.output.split())
    assert "There is no file 'no-such.yaml'; installed mapfiles: " in text
    assert "three_nodes, three_nodes.map" in text


@pytest.mark.parametrize("verb", [("run",), ("map", "check"), ("map", "show")], ids=" ".join)
def test_a_wrong_mapfile_is_one_line_with_its_place(mapfile: Path, verb: tuple[str, ...]) -> None:
    mapfile.write_text(MAPFILE.replace("core: 1", "kernel: 1"))
    result = manycore(*verb, str(mapfile))
    assert result.exit_code == EXIT_BAD_INPUT
    assert result.output.startswith(f"manycore: {mapfile}:2: nodes.talker.kernel")
    assert "Traceback" not in result.output


def test_a_program_that_does_not_exist_is_found_before_the_run(mapfile: Path) -> None:
    mapfile.write_text(MAPFILE.replace('"true"', "no-such-program"))
    result = manycore("run", str(mapfile))
    assert result.exit_code == EXIT_BAD_INPUT
    assert "no-such-program" in result.output


@pytest.mark.parametrize("words", [("--begin", "nan"), ("--end", "nan"), ("--end", "inf")])
def test_a_part_of_a_trace_is_finite(words: tuple[str, str], tmp_path: Path) -> None:
    result = manycore("profile", "import", str(tmp_path), *words)
    assert result.exit_code == EXIT_BAD_INPUT
    assert f"expected a number up to 4e+09, found {words[1]}." in result.output


def test_map_check_and_show(mapfile: Path) -> None:
    assert f"{mapfile}: 1 node in 1 cluster, " in manycore("map", "check", str(mapfile)).output
    shown = manycore("map", "show", str(mapfile)).output
    assert "/talker" in shown
    assert re.search(r"topic table\nid +topic +type +topic DSM bytes", shown)


def test_map_init_writes_a_template_once(tmp_path: Path) -> None:
    examples = Path(__file__).parents[3] / "rmw_manycore_py/examples"
    output = tmp_path / "map.yaml"
    words = ("map", "init", str(examples / "talker.py"), "-o", str(output))
    assert manycore(*words).exit_code == 0
    assert "talker:" in output.read_text()
    again = manycore(*words)
    assert again.exit_code == EXIT_BAD_INPUT
    assert "exists" in again.output


@pytest.mark.parametrize("argument", [":=1", "who:="])
def test_map_init_refuses_half_an_argument(tmp_path: Path, argument: str) -> None:
    result = manycore("map", "init", str(tmp_path / "demo.launch.xml"), argument)
    assert result.exit_code == EXIT_BAD_INPUT
    assert f"'{argument}': expected NAME:=VALUE" in result.output


def test_create_lists_what_it_wrote(mapfile: Path, tmp_path: Path) -> None:
    result = manycore("create", str(mapfile), "-o", str(tmp_path / "out"))
    assert result.exit_code == 0
    assert str(tmp_path / "out/topic_table.yaml") in result.output
    assert (tmp_path / "out/topic_table.yaml").is_file()


@pytest.mark.parametrize(
    "words",
    [
        ("topic", "list"),
        ("topic", "info", "/t"),
        ("node", "list"),
        ("node", "info", "/n"),
        ("service", "list"),
        ("service", "type", "/s"),
        ("action", "list"),
        ("action", "info", "/a"),
        ("param", "get", "/n", "p"),
        ("lifecycle", "get", "/n"),
        ("top",),
        ("status",),
    ],
    ids=" ".join,
)
def test_a_platform_that_is_not_there(words: tuple[str, ...]) -> None:
    result = manycore(*words, "--platform", "no-such-platform")
    assert result.exit_code == 1
    assert result.output.startswith("manycore: no platform 'no-such-platform'")


@pytest.mark.parametrize("words", [("topic", "list"), ("status",), ("bridge", "status"), ("top",)])
def test_a_platform_that_no_platform_can_be(words: tuple[str, ...]) -> None:
    result = manycore(*words, "--platform", "../lock")
    assert result.exit_code == 2
    assert result.output.startswith("manycore: --platform: expected a platform name of")


def test_clean_refuses_a_name_that_no_platform_can_have() -> None:
    result = manycore("clean", "..")
    assert result.exit_code == 2
    assert "found '..'" in result.output


def interrupt(*_: object) -> None:
    raise KeyboardInterrupt


@pytest.mark.parametrize(
    ("words", "interrupted", "status"),
    [
        (("run", "talker_listener"), "rmw_manycore_py.cli.common.starting.load_mapfile", 0),
        (("demo",), "rmw_manycore_py.cli.demo.load_mapfile", 0),
        (("run", "talker_listener"), "importlib.import_module", 0),
        (("status",), "importlib.import_module", 130),
        (("status",), "rmw_manycore_py.cli.common.view.platform_names", 130),
        (("bridge", "status"), "rmw_manycore_py.cli.common.view.platform_names", 130),
    ],
)
def test_ctrl_c_of_a_verb_that_is_coming_up(
    monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], interrupted: str, status: int
) -> None:
    monkeypatch.setattr(interrupted, interrupt)
    result = manycore(*words)
    assert (result.exit_code, result.output) == (status, "")
