# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Launch files of one node, made at random: parameters, conditions and commands with values."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import yaml

BOOLEANS = (
    *("true", "True", "TRUE", "false", "False", "1", "0", "yes", "no", "on", "Off", "y", "N"),
    *(" true ", "1 ", "truee", "2"),
)
NUMBERS = (
    *("0", "1", "-1", "1.0", "1.", ".5", "-.5", "+.5", "0.1", "0.30000000000000004", "007", "0483"),
    *("1e3", "1e-9", "1.0e+3", "1_000", "0x1F", "0o17", "0b11", "1:30", "nan", ".nan", "inf"),
    *("-.inf", "1e400", "1e-310", "12345678901234567890", "9223372036854775807", " 5 ", "5 6"),
)
TEXTS = (
    *("", "a", "b", "a b", " a ", "abc", "null", "~", "'5'", '"x"', "2024-01-01", "a: b", "- 1"),
    *("#c", "a #c", "*x", "&x y", "!!str 5", "!x 5", "{a: 1}", "a,b", "(1, 2)", "ä", "%", "@a"),
)
LISTS = (
    *("[1, 2]", "[1, 2.5]", "[1.5, 2.5]", "[a, b]", "[true, false]", "[]", "[1, a]", "['1', b]"),
    *("[true, 1]", "[1, true]", "[[1], [2]]", "[null]", "[1", "[y, n]", "['y', 'n']", "[1e3, 2e3]"),
)
TYPES = (
    *("bool", "int", "float", "str", "list_of_bool", "list_of_int", "list_of_float"),
    *("list_of_str", "yaml", "number"),
)
SEPARATED = (
    *("1,2", "1, 2", "a,b", "a, b", "true,false", "1.5,2.5", "1,2.5", "1,a", "a", "", ",", "1;2"),
)
COMMANDS = (
    *("echo out", "sh -c 'echo out; echo err >&2'", "sh -c 'echo err >&2; exit 3'", "false"),
    *("printf 5", "printf '[1, 2]'", "/no/such/command", "cat", "sh -c 'echo 1; echo 2 >&2'"),
)
MODES = ("fail", "ignore", "warn", "capture", "Capture", "", "true")


@dataclass(frozen=True)
class Made:
    """A launch file."""

    suffix: str
    text: str


PYTHON = """\
from typing import List
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import *
from launch_ros.actions import Node, SetParameter
from launch_ros.parameter_descriptions import Parameter, ParameterValue
def generate_launch_description():
    return LaunchDescription([{}])
"""


class Chance(random.Random):
    """Chooses what launch files are made of."""

    def word(self) -> str:
        return self.choice(self.choice((BOOLEANS, NUMBERS, TEXTS, LISTS)))

    def operand(self) -> str:
        return self.choice(self.choice((BOOLEANS, BOOLEANS, NUMBERS, TEXTS)))

    def boolean(self) -> str:
        return self.choice(BOOLEANS) if self.random() < 0.8 else self.operand()

    def likely(self, probability: float = 0.5) -> bool:
        return self.random() < probability


def made(number: int) -> Made:
    """Return the launch file of a number."""
    chance = Chance(number)
    family = chance.choices(FAMILIES, WEIGHTS)[0]
    return family(chance)


def xml(*tags: str) -> Made:
    return Made(".launch.xml", f"<launch>{''.join(tags)}</launch>\n")


def tag(kind: str, content: str = "", /, **attributes: str | None) -> str:
    given = {key.replace("_", "-"): value for key, value in attributes.items() if value is not None}
    words = "".join(f" {key}={quoteattr(value)}" for key, value in given.items())
    return f"<{kind}{words}>{content}</{kind}>"


def node(content: str, **attributes: str) -> str:
    return tag("node", content, exec="/bin/true", name="n", **attributes)


def yaml_file(*tags: object) -> Made:
    return Made(".launch.yaml", yaml.safe_dump({"launch": list(tags)}, allow_unicode=True))


def yaml_node(parameters: list[dict[str, object]]) -> dict[str, object]:
    described: dict[str, object] = {"exec": "/bin/true", "name": "n"}
    return {"node": described | ({"param": parameters} if parameters else {})}


def python(actions: str) -> Made:
    return Made(".launch.py", PYTHON.format(actions))


def python_node(parameters: str, more: str = "") -> str:
    return f"Node(executable='/bin/true', name='n', parameters=[{parameters}]{more})"


def declared(chance: Chance, name: str, value: str) -> str:
    return tag("arg", name=name, default=value.replace("\\", "\\\\").replace("$", "\\$"))


def logic_in_text(chance: Chance) -> Made:
    """Substitutions of logic, with operands as arguments or in place."""
    kind = chance.choice(("equals", "not-equals", "not", "and", "or", "if"))
    count = 1 if kind == "not" else 2
    choose = chance.operand if "equals" in kind else chance.boolean
    words, arguments = [], []
    for index in range(count):
        value = choose()
        if chance.likely(0.3) and not set(value) & set("'\"$()\\"):
            words.append(f"'{value}'")
        else:
            arguments.append(declared(chance, f"a{index}", value))
            words.append(f"$(var a{index})")
    if kind == "if":
        words = [words[0], "yes", *(["no"] if chance.likely() else [])]
    inner = f"$({kind} {' '.join(words)})"
    value = f"$(not {inner})" if chance.likely(0.2) and kind != "if" else inner
    return xml(*arguments, node(tag("param", name="r", value=value, type="str")))


def logic_in_python(chance: Chance) -> Made:
    def operand() -> str:
        values = ("True", "False", "None", "1", "0", "1.0", "0.1 + 0.2", "0.3", "2", "1e-30")
        return chance.choice(
            (
                chance.choice(values),
                repr(chance.operand()),
                f"LaunchConfiguration('a', default={chance.operand()!r})",
                f"LaunchConfiguration('a', default={chance.choice(values)})",
                f"TextSubstitution(text={chance.boolean()!r})",
                f"[TextSubstitution(text={chance.boolean()!r}), {chance.boolean()!r}]",
            )
        )

    kinds = ("Equals", "NotEquals", "Not", "And", "Or", "Any", "All")
    kind = chance.choice(kinds)
    count = {"Not": 1, "Any": 3, "All": 3}.get(kind, 2)
    made_of = ", ".join(operand() for _ in range(count))
    return python(
        python_node(f"{{'r': ParameterValue({kind}Substitution({made_of}), value_type=str)}}")
    )


def condition(chance: Chance) -> Made:
    which, value = chance.choice(("if", "unless")), chance.boolean()
    if chance.likely(0.3):
        kind = {"if": "IfCondition", "unless": "UnlessCondition"}[which]
        return python(python_node("", f", condition={kind}({value!r})"))
    return xml(declared(chance, "a", value), node("", **{which: "$(var a)"}))


def parameter_in_xml(chance: Chance) -> Made:
    attributes: dict[str, str | None] = {
        "type": chance.choice(TYPES) if chance.likely(0.7) else None
    }
    arguments = []
    value = chance.word()
    if chance.likely(0.4):
        attributes["value_sep"] = chance.choice((",", ",", ", ", ";"))
        value = chance.choice(SEPARATED)
    if chance.likely(0.3):
        arguments.append(declared(chance, "a", chance.word()))
        value = chance.choice(("$(var a)", f"{value}$(var a)", f"$(var a),{value}"))
    return xml(*arguments, node(tag("param", name="r", value=value, **attributes)))


def parameter_in_yaml(chance: Chance) -> Made:
    def scalar() -> object:
        if chance.likely(0.3):
            return chance.word()
        return chance.choice((True, False, 0, 1, -7, 2.5, 1.0, 1e300, "$(var a)", "x$(var a)"))

    value = [scalar() for _ in range(chance.randint(0, 3))] if chance.likely(0.4) else scalar()
    parameter: dict[str, object] = {"name": "r", "value": value}
    if chance.likely():
        parameter["type"] = chance.choice(TYPES)
    argument = {"arg": {"name": "a", "default": chance.choice(NUMBERS + BOOLEANS + LISTS)}}
    return yaml_file(argument, yaml_node([parameter]))


def set_parameter(chance: Chance) -> Made:
    """`set_parameter` of texts, also with `$(param)`; in YAML also of other values."""
    value = chance.word()
    if chance.likely(0.3):
        typed: object = chance.choice((value, True, 5, 2.5, [1, 2], ["a", "b"]))
        return yaml_file({"set_parameter": {"name": "r", "value": typed}}, yaml_node([]))
    more = tag("param", name="s", value="<$(param r none)>", type="str") if chance.likely() else ""
    return xml(tag("set_parameter", name="r", value=value), node(more))


def value_in_python(chance: Chance) -> Made:
    """Parameters of every form in Python."""
    value = python_value(chance)
    named = chance.choices(("dict", "Parameter", "set", "nested"), (6, 1, 2, 1))[0]
    if named == "Parameter":
        return python(python_node(f"Parameter('r', {value}, value_type={python_type(chance)})"))
    if named == "set":
        return python(f"SetParameter('r', {value}), {python_node('')}")
    if named == "nested":
        return python(python_node(f"{{'r': {{'s': {value}, 't': 1}}}}"))
    return python(python_node(f"{{'r': {value}}}"))


def python_type(chance: Chance) -> str:
    scalars = ("None", "bool", "int", "float", "str")
    return chance.choice((*scalars, "List[int]", "List[float]", "List[str]", "List[bool]"))


def python_value(chance: Chance, depth: int = 0) -> str:
    def scalar() -> str:
        values = ("True", "False", "0", "1", "-3", "2.5", "1.0", "float('nan')", "float('-inf')")
        return chance.choice((repr(chance.word()), chance.choice(values)))

    def substitution() -> str:
        return chance.choice(
            ("TextSubstitution(text={0!r})", "LaunchConfiguration('a', default={0!r})")
        ).format(chance.word())

    roll = chance.random()
    if roll < 0.25:
        return scalar()
    if roll < 0.45:
        return substitution()
    if roll < 0.6 and depth == 0:
        return f"ParameterValue({python_value(chance, 1)}, value_type={python_type(chance)})"
    if roll < 0.63:
        return chance.choice(("None", "object()", "{}", "()", "[[]]"))
    items = []
    same = chance.choice((scalar, substitution)) if chance.likely() else None
    for _ in range(chance.randint(0, 3)):
        choose = same or chance.choice((scalar, substitution))
        items.append(f"[{choose()}]" if chance.likely(0.2) else choose())
    if items and chance.likely(0.4):
        items = [items[0]] * len(items)
    return f"[{', '.join(items)}]"


def settings_of_groups(chance: Chance) -> Made:
    """What groups set, restore and leave."""
    before = tag("set_parameter", name="a", value="1") if chance.likely() else ""
    inner = tag("set_parameter", name="b", value=chance.choice(NUMBERS))
    inner += tag("push_ros_namespace", namespace="x") if chance.likely() else ""
    inner += tag("set_remap", **{"from": "p", "to": "q"}) if chance.likely() else ""
    scoped = chance.choice((None, "true", "false", "0", "yes", "$(var s)"))
    forwarding = chance.choice((None, None, "true", "false"))
    group = tag("group", inner, scoped=scoped, forwarding=forwarding)
    if chance.likely(0.3):
        group += "<reset/>"
    return xml(
        declared(chance, "s", "false"), before, group, node(tag("param", name="c", value="2"))
    )


def command(chance: Chance) -> Made:
    line, mode = chance.choice(COMMANDS), chance.choice((None, *MODES))
    words = json.dumps(line) + ("" if mode is None else f" {mode or '$(var none)'}")
    none = declared(chance, "none", "")
    kind = "str" if chance.likely(0.7) else None
    return xml(none, node(tag("param", name="r", value=f"$(command {words})", type=kind)))


def escaped(chance: Chance) -> Made:
    pieces = ("\\", "$", "\\$", "a", " ", "\\n", "'", '\\"', "$(var a)", "\\\\", "x")
    value = "".join(chance.choice(pieces) for _ in range(chance.randint(1, 5)))
    return xml(declared(chance, "a", "A"), node(tag("param", name="r", value=value, type="str")))


FAMILIES: tuple[Callable[[Chance], Made], ...] = (
    *(logic_in_text, logic_in_python, condition, parameter_in_xml, parameter_in_yaml),
    *(set_parameter, value_in_python, settings_of_groups, command, escaped),
)
WEIGHTS = (14, 8, 4, 18, 14, 10, 24, 4, 2, 2)
