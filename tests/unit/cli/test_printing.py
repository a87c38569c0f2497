# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Text that other processes chose does not control the terminal."""

from __future__ import annotations

from pathlib import Path

import pytest
from rich.console import Console
from rich.text import Text

import rmw_manycore_py.cli
from rmw_manycore_py.cli.common.printing import (
    echo,
    escaped,
    json_text,
    new_table,
    print_table,
)

pytestmark = pytest.mark.unit

CLI = Path(rmw_manycore_py.cli.__file__).parent
# Styled text, output of nodes, scripts for the shell.
PRINT_RAW = {
    "common/printing.py",
    "common/run_printer.py",
    "completion.py",
    "doctor/__init__.py",
    "env.py",
    "logs.py",
    "status.py",
    "top/__init__.py",
}


def test_names_are_escaped() -> None:
    assert escaped("a\x1b[31m\nb\t\r\x00\x9b\u202e\u2028") == (
        r"a\x1b[31m\nb\t\r\x00\x9b\u202e\u2028"
    )
    assert escaped("\u200e\u200f\u061c") == "\u200e\u200f\u061c"
    assert escaped("/größe 😀 ‍") == "/größe 😀 ‍"


def test_lines_and_tabs_of_a_text_stay(capsys: pytest.CaptureFixture[str]) -> None:
    echo("a\n\tb\x1b[2J", nl=False)
    assert capsys.readouterr().out == "a\n\tb\\x1b[2J"


def test_json_has_texts_for_numbers_that_it_lacks() -> None:
    data = {"a": [1.5, float("inf"), {"b": float("nan")}], "c": (-float("inf"),), "d": Path("x")}
    text = '{"a": [1.5, "inf", {"b": "nan"}], "c": ["-inf"], "d": "x"}'
    assert json_text(data) == text
    assert (
        json_text({"one": b"\xff", "two": [b"\x00", b"ab"]}) == '{"one": 255, "two": [0, [97, 98]]}'
    )


def test_cells_are_no_markup(capsys: pytest.CaptureFixture[str]) -> None:
    table = new_table("name", "#number")
    table.add_row("[/red]\x07\n[b]", Text("1\x1b", "red"))
    print_table(table)
    assert capsys.readouterr().out.split("\n")[1].split() == [r"[/red]\x07\n[b]", r"1\x1b"]


@pytest.mark.parametrize(
    ("width", "shown"),
    [
        (60, ["pid", "program", "node", "state"]),
        (40, ["pid", "node", "state"]),
        (28, ["node", "state"]),
    ],
)
def test_in_a_narrow_terminal_columns_give_way_to_names(width: int, shown: list[str]) -> None:
    table = new_table("#pid", "program", "node", "state", expendable=("program", "pid"))
    table.add_row("12345", "my_robot detector", "/robot/detector", "alive")
    console = Console(width=width)
    with console.capture() as capture:
        console.print(table)
    head, row = capture.get().splitlines()
    assert head.split() == shown
    assert "/robot/detector" in row


def test_verbs_print_through_it() -> None:
    raw = {
        str(file.relative_to(CLI))
        for file in CLI.rglob("*.py")
        if "click.echo(" in file.read_text() or "click.secho(" in file.read_text()
    }
    assert raw == PRINT_RAW
