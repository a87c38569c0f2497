# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Runs the generators of rosidl, as a separate program since they keep state and print.

    python -m rmw_manycore_py.interfaces.generator STEP REQUEST

`describe` writes an .idl file and a type description with hash per definition; `code` then
generates C for some of them, `python` Python for all. REQUEST is the JSON file of a `Request`.
"""

from __future__ import annotations

import json
import pickle
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import rosidl_generator_type_description
import rosidl_pycommon
from rosidl_adapter.action import convert_action_to_idl
from rosidl_adapter.msg import convert_msg_to_idl
from rosidl_adapter.srv import convert_srv_to_idl
from rosidl_parser.parser import parse_idl_file

from rmw_manycore_py.errors import what_is_wrong

# rmw_manycore and Fast DDS serialize with the first; Fast DDS builds its types from the second.
TYPE_SUPPORTS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")
DESCRIPTION = "rosidl_generator_type_description"
PYTHON = "rosidl_generator_py"
_CONVERT = {
    ".msg": convert_msg_to_idl,
    ".srv": convert_srv_to_idl,
    ".action": convert_action_to_idl,
}


@dataclass(frozen=True)
class Request:
    """What to generate; output goes to `output`/GENERATOR/`package`."""

    package: str
    source: str  # directory of the package
    definitions: list[str]  # files in `source`: msg/Name.msg
    output: str
    share: str  # share/ directory of the generators
    dependencies: dict[str, str]  # share/PACKAGE directories of other packages

    def place(self, generator: str) -> Path:
        """Return the output directory of a generator."""
        return Path(self.output, generator, self.package)

    def idl(self) -> list[Path]:
        """Return the .idl files, relative to `place("idl")`."""
        return [Path(name).with_suffix(".idl") for name in self.definitions]

    def description(self, idl: Path) -> Path:
        """Return the path of the type description of an .idl file."""
        return self.place(DESCRIPTION) / idl.with_suffix(".json")


def describe(request: Request) -> None:
    """Write an .idl file and a type description with hash per definition."""
    for name in request.definitions:
        file, place = Path(request.source, name), request.place("idl") / Path(name).parent
        if file.suffix == ".idl":
            place.mkdir(parents=True, exist_ok=True)
            (place / file.name).write_bytes(file.read_bytes())
        else:
            _CONVERT[file.suffix](Path(request.source), request.package, Path(name), place)
    _parse_once()
    dependencies = [f"{package}:{share}" for package, share in request.dependencies.items()]
    arguments = _arguments(request, DESCRIPTION, include_paths=dependencies)
    rosidl_generator_type_description.generate_type_hash(arguments)


def generate_code(request: Request) -> None:
    """Generate C for definitions processed by `describe`."""
    import rosidl_generator_c
    import rosidl_typesupport_c
    import rosidl_typesupport_fastrtps_c
    import rosidl_typesupport_introspection_c

    _parse_once()
    hashes = [f"{idl}:{request.description(idl)}" for idl in request.idl()]
    rosidl_generator_c.generate_c(
        _arguments(request, "rosidl_generator_c", type_description_tuples=hashes)
    )
    fastrtps, introspection = TYPE_SUPPORTS
    rosidl_typesupport_fastrtps_c.generate_typesupport_fastrtps_c(_arguments(request, fastrtps))
    rosidl_typesupport_introspection_c.generate_c(_arguments(request, introspection))
    rosidl_typesupport_c.generate_c(
        _arguments(request, "rosidl_typesupport_c"), list(TYPE_SUPPORTS)
    )


def generate_python(request: Request) -> None:
    """Generate the Python package, from all definitions, since its modules list them."""
    import rosidl_generator_py.generate_py_impl

    rosidl_generator_py.generate_py_impl.parse_idl_file = _parsed
    _parse_once()
    rosidl_generator_py.generate_py(_arguments(request, PYTHON), ["rosidl_typesupport_c"])


def write_visibility_headers(request: Request) -> None:
    """Write the headers that control symbol visibility."""
    for generator in ("rosidl_generator_c", *TYPE_SUPPORTS):
        name = f"{generator}__visibility_control.h"
        text = Path(request.share, generator, "resource", f"{name}.in").read_text()
        text = text.replace("@PROJECT_NAME@", request.package)
        text = text.replace("@PROJECT_NAME_UPPER@", request.package.upper())
        header = request.place(generator) / "msg" / name
        header.parent.mkdir(parents=True, exist_ok=True)
        header.write_text(text)


def _parse_once() -> None:
    """Cache parsed definitions for the next generator, which would take seconds to parse them."""
    for module in (rosidl_pycommon, rosidl_generator_type_description):
        module.parse_idl_file = _parsed


def _parsed(locator: Any, png_file: str | None = None) -> Any:
    kept = locator.get_absolute_path().with_suffix(".parsed")
    try:
        return pickle.loads(kept.read_bytes())
    except FileNotFoundError:
        parsed = parse_idl_file(locator, png_file)
        kept.write_bytes(pickle.dumps(parsed))
        return parsed


def _arguments(request: Request, generator: str, **more: Any) -> str:
    """Write the argument file of a generator; return its path."""
    place = request.place(generator)
    place.mkdir(parents=True, exist_ok=True)
    arguments = {
        "package_name": request.package,
        "output_dir": str(place),
        "template_dir": str(Path(request.share, generator, "resource")),
        "idl_tuples": [f"{request.place('idl')}:{idl}" for idl in request.idl()],
        "ros_interface_dependencies": [],
        "target_dependencies": [],
        **more,
    }
    first = request.definitions[0].replace("/", ".")
    file = Path(request.output, "arguments", f"{generator}-{request.package}-{first}.json")
    file.parent.mkdir(exist_ok=True)
    file.write_text(json.dumps(arguments))
    return str(file)


STEPS = {"describe": describe, "code": generate_code, "python": generate_python}


def main(step: str, file: str) -> None:
    """Run one step of the request in a file; on failure, print one line that begins `error:`."""
    try:
        STEPS[step](Request(**json.loads(Path(file).read_text())))
    except Exception as error:  # generators assert, or fail in their templates
        sys.exit(f"error: {what_is_wrong(error)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
