# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Mutations of files: of the data, lines and words of YAML, XML and Python, and of bytes."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import MapfileError
from rmw_manycore_py.mapfile.format.document import parse_yaml

Mutate = Callable[[random.Random, str], str]

_BOMB = "&b0 [x, x, x, x, x, x, x, x, x, x]"
for _level in range(1, 10):
    _BOMB = f"[&b{_level} [{', '.join([f'*b{_level - 1}'] * 10)}], {_BOMB}]"
# Inserted into the text unchanged.
SNIPPETS = (
    *("null", "true", "-1", "0", "1.5", ".nan", ".inf", "1e999", "''", "[]", "{}", "~", "none"),
    *("2024-01-01", "2024-13-01", "2024-01-01 25:61:61", "12:30:45", "1:" + "59:" * 80 + "0"),
    *("9" * 5000, "0x" + "f" * 5000, "1" * 25, "!!int abc", "!!float x", "!!bool 3", "!!null x"),
    *("!!timestamp x", "!!binary x", "!!set {a}", "!!omap [a: 1]", "!!python/name:os.system"),
    *("!unknown x", "!!str 3", "!!map [1]", "!!seq {a: 1}", "&a [*a]", "*nowhere", "&a {<<: *a}"),
    *("{<<: 3}", "{<<: [3]}", "{? [a] : b}", "{? {a: b} : c}", "{1: 2, true: 3, null: 4}", "[[1]]"),
    *("[" * 3000, "{a: " * 3000, "- " * 3000, "'" + "a" * 5000 + "'", _BOMB, "~nobody_here/x"),
    *(
        '"\\0"',
        '"\\e[31m"',
        '"\\ud800"',
        '"\\UFFFFFFFF"',
        '"a\\nb"',
        '"\\u2028"',
        "\u00fc",
        "\ufeff",
    ),
    *(
        "|\n  x",
        ">-\n x",
        "@",
        "`",
        "%YAML 9.9",
        "---",
        "...",
        "? ",
        ": ",
        "- ",
        "#",
        "\t",
        "\u0085",
    ),
    *("[key]", "=", "<<", "..", "/", "//", "a/b/c/d", "../..", "/dev/null", "a b", "$(var x)"),
    *("$(eval '1+1')", "$(eval '1/0')", "$(env HOME)", "$(" * 300, "$(not " * 300, "$(if", "$()"),
    *("&amp;", "&x;", "<x>", "</launch>", "<group>" * 300, "<!DOCTYPE l [<!ENTITY x 'y'>]>", "]]>"),
)
_BYTES = (
    *(b"\0", b"\x1b", b"\xff", b"\xc3", b"\xef\xbb\xbf", b"\r", b"\r\n", b"\x85", b"\x7f", b"\t"),
)
_PUNCTUATION = "{}[]:,&*!|>'\"%@`#-?<>$()=/\\ \n\t"


def _places(data: Any) -> Iterator[tuple[Any, Any]]:
    """Yield each container in the data with each of its keys or indices."""
    if isinstance(data, (dict, list)):
        for key in list(data) if isinstance(data, dict) else range(len(data)):
            yield data, key
            yield from _places(data[key])


def mutated_data(chance: random.Random, text: str) -> str:
    """Change values, keys and nesting of a YAML text; if it is invalid, change its lines."""
    try:
        data = parse_yaml(text, Path()).data
        # Names stand for the snippets in the data, as a dumper would quote these.
        for number in range(chance.choice((1, 1, 1, 2, 3))):
            _change(chance, data, f"snippet{number}x")
        written = yaml.safe_dump(data, default_flow_style=chance.random() < 0.5, sort_keys=False)
    except (MapfileError, yaml.YAMLError, IndexError, RecursionError):
        return mutated_lines(chance, text)
    for number in range(3):
        written = written.replace(f"snippet{number}x", chance.choice(SNIPPETS))
    return written


def _change(chance: random.Random, data: Any, snippet: str) -> None:
    container, key = chance.choice(list(_places(data)))
    value = container[key]
    what = chance.randrange(7)
    if what == 0:
        del container[key]
    elif what == 1 and isinstance(container, dict):
        container[snippet] = container.pop(key)
    elif what == 2 and isinstance(container, dict):
        container[snippet] = snippet
    elif what == 3:
        container[key] = chance.choice(([value], {snippet: value}, [value, snippet], str(value)))
    elif what == 4:
        other, other_key = chance.choice(list(_places(data)))
        container[key] = other[other_key] if other is not container else snippet
    else:
        container[key] = snippet


def mutated_lines(chance: random.Random, text: str) -> str:
    """Repeat, remove, swap, indent or cut lines."""
    lines = text.splitlines(keepends=True) or [""]
    at = chance.randrange(len(lines))
    other = chance.randrange(len(lines))
    what = chance.randrange(6)
    if what == 0:
        lines.insert(at, lines[other])
    elif what == 1:
        del lines[at]
    elif what == 2:
        lines[at], lines[other] = lines[other], lines[at]
    elif what == 3:
        lines[at] = " " * chance.randrange(9) + lines[at].lstrip()
    elif what == 4:
        lines[at] = lines[at].rstrip("\n")
    else:
        lines[at:] = [lines[at][: chance.randrange(len(lines[at]) + 1)]]
    return "".join(lines)


def mutated_words(chance: random.Random, text: str) -> str:
    """Insert a snippet or a punctuation mark, or replace a word by it."""
    at = chance.randrange(len(text) + 1)
    put = chance.choice(SNIPPETS) if chance.random() < 0.6 else chance.choice(_PUNCTUATION)
    end = at
    while end < len(text) and text[end].isalnum():
        end += 1
    return text[:at] + put + text[end if chance.random() < 0.5 else at :]


def mutated_bytes(chance: random.Random, content: bytes) -> bytes:
    """Truncate the content, or insert bytes that are not valid in text."""
    at = chance.randrange(len(content) + 1)
    what = chance.randrange(4)
    if what == 0:
        return content[:at]
    if what == 1:
        return content.replace(b"\n", b"\r\n")
    if what == 2:
        return chance.choice(_BYTES) + content
    return content[:at] + chance.choice(_BYTES) + content[at:]


def damaged(chance: random.Random, content: bytes, patches: Sequence[bytes]) -> bytes:
    """Flip a bit, overwrite, remove or repeat some bytes, up to five times."""
    changed = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 5))):
        at = chance.randrange(len(changed))
        what = chance.randrange(4)
        if what == 0:
            changed[at] ^= 1 << chance.randrange(8)
        elif what == 1:
            changed[at : at + 8] = chance.choice(patches)
        elif what == 2:
            del changed[at : at + chance.randrange(1, 20)]
        else:
            changed[at:at] = changed[: chance.randrange(1, 40)]
    return bytes(changed) or b"\0"


def mutated(chance: random.Random, content: bytes, kinds: tuple[Mutate, ...]) -> bytes:
    """Apply some mutations of these kinds, and sometimes one of bytes."""
    text = content.decode(errors="replace")
    for _ in range(chance.choice((0, 1, 1, 1, 2, 3))):
        text = chance.choice(kinds)(chance, text)
    content = text.encode(errors="surrogatepass")
    return mutated_bytes(chance, content) if chance.random() < 0.25 else content
