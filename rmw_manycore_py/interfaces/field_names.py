# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Field names that are not possible in the generated code."""

from __future__ import annotations

import keyword
from pathlib import Path

from rmw_manycore_py.errors import DefinitionError, Problem

# Keywords that cannot be field names in generated C and C++.
_C_WORDS = frozenset(
    {
        *("alignas", "alignof", "asm", "auto", "bool", "break", "case", "catch", "char", "class"),
        *("const", "constexpr", "const_cast", "continue", "decltype", "default", "delete", "do"),
        *("double", "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false"),
        *("float", "for", "friend", "goto", "if", "inline", "int", "long", "mutable", "namespace"),
        *("new", "noexcept", "nullptr", "operator", "private", "protected", "public", "register"),
        *("reinterpret_cast", "restrict", "return", "short", "signed", "sizeof", "static"),
        *("static_assert", "static_cast", "struct", "switch", "template", "this", "thread_local"),
        *("throw", "true", "try", "typedef", "typeid", "typename", "union", "unsigned", "using"),
        *("virtual", "void", "volatile", "wchar_t", "while"),
    }
)


def check_field_name(file: Path, line: int, name: str) -> None:
    """Raise DefinitionError for a keyword of Python, C or C++."""
    if keyword.iskeyword(name) or name in _C_WORDS:
        expected = "a name that is no keyword of Python, C or C++"
        raise DefinitionError(Problem(file, line, name, expected, f"'{name}'"))
