# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Numbers on the command line: each option refuses those that no part behind it can take."""

from __future__ import annotations

from collections.abc import Iterator

import click
import pytest
from click.testing import CliRunner

from rmw_manycore_py.cli.main import cli
from rmw_manycore_py.errors import EXIT_BAD_INPUT

pytestmark = pytest.mark.unit

NUMBERS = click.IntRange, click.FloatRange


def numbers(group: click.Group = cli) -> Iterator[click.Parameter]:
    """Yield the parameters of all verbs that are numbers within bounds."""
    context = click.Context(group)
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None
        if isinstance(command, click.Group):
            yield from numbers(command)
        yield from (one for one in command.params if isinstance(one.type, NUMBERS))


def test_bounds_are_those_of_a_number_that_fits() -> None:
    parameters = list(numbers())
    assert len(parameters) > 100
    for parameter in parameters:
        for text in ("nan", "1e300", f"1{30 * '0'}", "-inf"):
            with pytest.raises(click.BadParameter):
                parameter.type.convert(text, parameter, None)


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        ("bench virtual talker_listener --timeout inf", "expected seconds that end, found inf"),
        ("whill sweep --timeout inf", "expected seconds that end, found inf"),
        ("top --period 1e12", "expected a number up to 4e+09, found 1e12"),
        (f"logs --tail 1{30 * '0'}", "expected a number up to 9223372036854775807"),
        ("topic echo /t --qos-depth 1048577", "not in the range 1<=x<=1048576"),
        ("topic pub /t std_msgs/msg/String --rate 1e-12", "not in the range x>=1e-09"),
        ("service call /s std_srvs/srv/Empty --rate 1e-12", "not in the range x>=1e-09"),
    ],
)
def test_numbers_out_of_bounds_are_refused(words: str, complaint: str) -> None:
    result = CliRunner().invoke(cli, words.split())
    assert result.exit_code == EXIT_BAD_INPUT
    assert complaint in result.output
