# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Definitions made at random: most are valid, others have a flaw or two."""

from __future__ import annotations

import random
from dataclasses import dataclass

from support.generated.mutation import mutated, mutated_lines, mutated_words

NAME = "Thing"
PACKAGE = "my_msgs"
PARTS = {
    "msg": [""],
    "srv": ["_Request", "_Response"],
    "action": ["_Goal", "_Result", "_Feedback"],
}
FLAW = 0.04  # chance of one where there can be one

_PRIMITIVES = (
    *("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32"),
    *("uint32", "int64", "uint64", "string", "wstring", "string<=5", "wstring<=3"),
)
_TYPES = ("Part", "geometry_msgs/Pose", "std_msgs/Header", "std_msgs/String")
_ODD_TYPES = (
    *("time", "duration", "a/b/C", "lower", "string<=0", "string<=x", "x_/Y", "Part.msg", "[]"),
    *("float", "Sample_Part", "geometry_msgs/msg/Pose", "int32[", "string<5"),
)
_SUFFIXES = ("", "", "", "[]", "[3]", "[<=4]")
_ODD_SUFFIXES = ("[0]", "[-1]", "[x]", "[99999999999999999999]", "]", "[3][4]", "[ 3 ]", "[<=]")
_NAMES = tuple("abcdefghijklmnopqrstuvwxyz")
_ODD_NAMES = (
    *("from", "double", "A", "x__y", "int", "x_", "1a", "a-b", "é", "none", "self", "class", "_x"),
    *("structure_needs_at_least_one_member", "", "a.b", "a,b"),
)
_NUMBERS = ("0", "1", "200", "0x1f", "0b1", "1_0", "  7", "true")
_VALUES = (
    *("", "-1", "256", "1.5", "nan", "inf", "1e400", "True", "'a'", '"b"', '"it\'s"', "'\\\\'"),
    *('"\\""', "[1,2,3]", "[1, 2]", "[]", "['a','b']", "['a,b', \"c\"]", '["]', "é", "\\x", "a b"),
    *("\\u12", "'\\N{DASH}'", "9" * 30, "[true,false]", '"??/"', "'a\\nb'", '"#"', "%d", "@x"),
    *("@(1)", "$x", "*/", "//", "日本", "\\", "'", "\\'", "'\\t'", "\\\\\\"),
)
_COMMENTS = (
    *("# c", "#", "# é", "# [m/s]", "# */", '# "q" \' ', "\t# x", "# @(x)", "# C:\\temp", "# 日"),
    *("   # indented", "# a # b", "## [m] x", "# [a,b]"),
)
_ODD_COMMENTS = ("# \\", "# a\\u12", "# C:\\new", "# \\x", "#\\N{x}", '# \\"')
_IDL_TYPES = (
    *("boolean", "octet", "char", "wchar", "float", "double", "short", "long", "int8", "uint8"),
    *("int16", "int32", "uint64", "unsigned short", "long long", "unsigned long long", "string"),
    *("wstring", "string<5>", "wstring<4>", "sequence<long>", "sequence<long, 3>"),
    *("sequence<string<3>, 4>", "my_msgs::msg::Part", "geometry_msgs::msg::Pose", "Alias"),
    *("sequence<geometry_msgs::msg::Pose>", "sequence<Alias>", "std_msgs::msg::Header"),
)
_ODD_IDL_TYPES = (
    *("Color", "Alias2", "Nope", "sequence<Color>", "geometry_msgs::Pose", "a::b::c::D", "::X"),
    *("sequence<sequence<long>>", "string<0>", "sequence<long, N>", "fixed<3, 2>", "long double"),
    *("sequence<long double>", "sequence<long, 0>", "int", "my_msgs::srv::Do_Request", "any"),
    *("::geometry_msgs::msg::Pose", "struct X", "sequence<geometry_msgs::Pose>", "sequence<X, Y>"),
)
_ODD_SIZES = ("[2][2]", "[N]", "[0]", "[1+1]", "[3], y", "[-1]", "[]", "[0x3]", "[2], x[3]")
_ANNOTATIONS = (
    *("", "", "", "@key ", "@default(value=3) ", '@unit("m") ', "@range(min=1, max=2) "),
    '@verbatim(language="comment", text="x" "y") ',
)
_ODD_ANNOTATIONS = ("@x(1+1) ", "@x() ", "@default(3) ", "@default @default ", "@x(0x3) ", "@ ")
_CONSTANTS = ("long X = 1", "long Y = -1", "string S = 'x'", 'string S = "s"', "boolean B = TRUE")
_ODD_CONSTANTS = (
    *("long X = 1+1", "long X = 0x1f", "long X = 017", 'wstring W = L"a"', 'wstring W = "a"'),
    *("long X = TRUE", "octet O = 1", "char C = 'a'", "Color C = RED", "fixed F = 3d"),
    *("double D = 1.5", "double D = 1", 'string S = "s" "t"', "long X = (1)", "long X = ~1"),
    "long X = N",
)


@dataclass(frozen=True)
class Made:
    """A file of a package of definitions."""

    kind: str
    suffix: str
    content: bytes

    @property
    def structures(self) -> list[str]:
        """Return package/kind/Name of each structure that the file has to define."""
        return [f"{PACKAGE}/{self.kind}/{NAME}{part}" for part in PARTS[self.kind]]


def made(number: int) -> Made:
    """Return the definition of a number."""
    chance = _Chance(number)
    kind = chance.choice(("msg", "msg", "srv", "action"))
    suffix = "idl" if chance.random() < 0.4 else kind
    content = (_idl(chance, kind) if suffix == "idl" else _text(chance, kind)).encode()
    if chance.random() < 0.2:
        content = mutated(chance, content, (mutated_lines, mutated_words))
    return Made(kind, suffix, content)


class _Chance(random.Random):
    def one(self, good: tuple[str, ...], odd: tuple[str, ...]) -> str:
        return self.choice(odd if self.random() < FLAW else good)


def _text(chance: _Chance, kind: str) -> str:
    parts = []
    for _ in PARTS[kind]:
        names = iter(chance.sample(_NAMES, len(_NAMES)))
        parts.append("\n".join(_line(chance, next(names)) for _ in range(chance.randrange(5))))
    separator = chance.one(("\n---\n",), ("\n--- \n", "\n----\n", "\n---\n---\n", "\n"))
    return separator.join(parts) + chance.choice(("\n", "", "\n\n"))


def _line(chance: _Chance, name: str) -> str:
    space = chance.one((" ", "  ", "\t"), ("", "\u00a0", "\x0b"))
    if chance.random() < 0.15:
        return chance.one((*_COMMENTS, ""), _ODD_COMMENTS)
    if chance.random() < 0.25:
        type_ = chance.one(_PRIMITIVES[:15], (*_TYPES, "string<=5", "int32[]"))
        key = chance.one((f"{name.upper()}_1", name.upper()), ("a", "X__Y", "_X", "X_"))
        text = f"{type_}{space}{key}{chance.choice(('=', ' = ', '= '))}{_value(chance)}"
    else:
        type_ = chance.one((*_PRIMITIVES, *_TYPES), _ODD_TYPES)
        type_ += chance.one(_SUFFIXES, _ODD_SUFFIXES)
        text = f"{type_}{space}{chance.one((name,), _ODD_NAMES)}"
        text += f" {_value(chance)}" if chance.random() < 0.15 else ""
    return text + (f" {chance.one(_COMMENTS, _ODD_COMMENTS)}" if chance.random() < 0.2 else "")


def _value(chance: _Chance) -> str:
    return chance.choice(_NUMBERS if chance.random() < 0.7 else _VALUES)


def _idl(chance: _Chance, kind: str) -> str:
    names = [NAME + part for part in PARTS[kind]]
    if chance.random() < FLAW:
        others = [[], [*names, "More"], names[:-1], ["Wrong"], [NAME, "More"], names[::-1]]
        names = chance.choice([*others, [NAME] * len(names), ["A_Request", "B_Response"]])
    body = ["enum Color { RED, GREEN };"] if chance.random() < 0.3 else []
    target = chance.one(_IDL_TYPES[:20], (*_ODD_IDL_TYPES, "Alias"))
    body.append(f"typedef {target} Alias{chance.one(('', '[3]'), (*_ODD_SIZES, ', B'))};")
    if chance.random() < 0.2:
        body.append("typedef Alias Alias2;")
    for name in names:
        if chance.random() < 0.2:
            constant = chance.one(_CONSTANTS, _ODD_CONSTANTS)
            body.append(f"module {name}_Constants {{ const {constant}; }};")
        members = "\n".join(_member(chance, letter) for letter in _NAMES[: chance.randint(1, 4)])
        body.append(f"struct {name} {{\n{members}\n}};")
    if chance.random() < FLAW:
        body.append(chance.choice(("struct Forward;", "union U { };", "const long N = 3;", "};")))
    modules = chance.choice(((PACKAGE,), ("other", "msg"), (PACKAGE, "msg", "more"), ()))
    text = "\n".join(body)
    for module in reversed((PACKAGE, kind) if chance.random() > FLAW else modules):
        text = f"module {module} {{\n{text}\n}};"
    includes = ("", '#include "geometry_msgs/msg/Pose.idl"\n')
    include = chance.one(includes, ("#include <x>\n", "#x\n"))
    return f"{include}{text}\n"


def _member(chance: _Chance, name: str) -> str:
    type_ = chance.one(_IDL_TYPES, _ODD_IDL_TYPES)
    annotation = chance.one(_ANNOTATIONS, _ODD_ANNOTATIONS)
    name = chance.one((name,), _ODD_NAMES)
    size = chance.one(("", "", "", "[3]", f", {name}_2"), _ODD_SIZES)
    return f"  {annotation}{type_} {name}{size};"
