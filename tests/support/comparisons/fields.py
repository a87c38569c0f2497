# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Compares fast fields with generated setters alone, on all installed messages.

    python [-O] -m support.comparisons.fields

A sequence or array of numbers gets each value twice, in setter and constructor, with and without
upstream's checks: once with our `array` in the generated module, once with Python's.
Prints, as JSON, the number of fields and comparisons and the first differences.
"""

from __future__ import annotations

import array
import importlib
import json
import re
import sys
import sysconfig
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import rmw_manycore_fields as fields
from support.generated.field_values import Made, made_values

Caught = list[warnings.WarningMessage]

NUMBERS = re.compile(r"(sequence<)?(u?int\d+|float|double|boolean|octet|char)(, \d+)?(>|\[\d+\])")
ADDRESS = re.compile(r"0x[0-9a-f]+")
MAX_SHOWN = 20
MODES = ((False, False), (False, True), (True, False), (True, True))  # checked, constructed
# One message per type code, which gets all values in all modes. Every other field gets a part of
# them in one mode, each field another.
ALL_VALUES = "std_msgs.msg."
STEP = 25


def generated_classes() -> Iterator[tuple[ModuleType, type]]:
    """Import every installed package of messages, and return its classes with their modules."""
    site_packages = Path(sysconfig.get_path("purelib"))
    for kind in ("msg", "srv", "action"):
        for init in sorted(site_packages.glob(f"*/{kind}/__init__.py")):
            package = importlib.import_module(f"{init.parents[1].name}.{kind}")
            for name in sorted(vars(package)):
                module = getattr(package, name)
                if name.startswith("_") and isinstance(module, ModuleType):
                    for member in list(vars(module).values()):
                        if hasattr(member, "SLOT_TYPES") and hasattr(member, "__slots__"):
                            yield module, member


def number_fields(message: type) -> list[str]:
    types = message.get_fields_and_field_types()
    return [name for name, type_ in types.items() if NUMBERS.fullmatch(type_)]


def outcome(message: type, field: str, made: Made, checked: bool, constructed: bool) -> Any:
    """Return the value that the field has at the end, or the error."""
    value = made()
    try:
        if constructed:
            target = message(check_fields=checked, **{field: value})
        else:
            target = message(check_fields=checked)
            setattr(target, field, value)
        result = getattr(target, field)
        is_array = isinstance(result, array.array)
        content = result.tobytes() if is_array else repr(result)
        told: Any = (type(result), is_array and result.typecode, content, result is value)
    except Exception as error:
        told = (type(error), str(error))
    return ADDRESS.sub("", repr(told))


def main() -> None:
    # Recorded all the time: to begin and end that costs as much as a comparison.
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        shown = compare_all(caught)
    json.dump(shown, sys.stdout, indent=1)


def compare_all(caught: Caught) -> dict[str, Any]:
    values = list(made_values().items())
    counts = {"values": len(values), "classes": 0, "fields": 0, "fast_fields": 0, "comparisons": 0}
    differences: list[tuple[str, ...]] = []
    for module, message in generated_classes():
        names = number_fields(message)
        counts["classes"] += 1
        counts["fields"] += len(names)
        for field in names if "array" in vars(module) else ():  # others do not change
            first = counts["fast_fields"] = counts["fast_fields"] + 1
            is_own = module.__name__.startswith(ALL_VALUES)
            modes = MODES if is_own else MODES[first % 4 :][:1]
            for name, made in values if is_own else values[first % STEP :: STEP]:
                counts["comparisons"] += len(modes)
                for mode in modes:
                    difference = compared(caught, module, message, field, made, *mode)
                    where = f"{message.__module__}.{message.__name__}.{field} = {name}"
                    differences += [(where, *difference)] if difference else []
    return {**counts, "different": len(differences), "differences": differences[:MAX_SHOWN]}


def compared(
    caught: Caught, module: ModuleType, message: type, field: str, made: Made, *mode: bool
) -> list[str]:
    """Return what each of the two does, with all warnings, if they differ."""
    outcomes = []
    for module.array in (array, fields.fast_array()):
        caught.clear()
        told = outcome(message, field, made, *mode)
        outcomes.append(f"{told} {[(one.category, str(one.message)) for one in caught]}")
    return outcomes if outcomes[0] != outcomes[1] else []


if __name__ == "__main__":
    main()
